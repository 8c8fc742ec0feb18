#pragma once

#include <cstdint>
#include <istream>
#include <optional>
#include <string>

#include "estimator/messages.h"
#include "scenarios/sensor_message.h"

/// Messages as bytes: what an outside estimator reads and what a dataset's messages.plb holds. Version 1, everything
/// little-endian, i and u integers of so many bits, f IEEE 754 floats.
///
///     stream       "PLUMBMSG", u32 version, u32 size, calibration YAML of that size, then records
///     record       u32 kind, u32 size of the payload, i64 delivery_ns, payload
///     1 IMU        i64 stamp_ns, f64[3] angular_rate, f64[3] specific_force                              (56 bytes)
///     2 camera     i64 stamp_ns, i32 camera_id, u32 width, u32 height, u8[height][width]
///     3 depth      i64 stamp_ns, i32 camera_id, u32 width, u32 height, f32[height][width] metres
///     4 lidar      i64 stamp_ns, i64 end_ns, i64 sweep, u32 ends_sweep (0 or 1), u32 count, then `count` points:
///                  f32 x, f32 y, f32 z, f32 intensity, i32 offset_ns, u16 ring, u16 zero                 (24 bytes)
///     0 end        no payload, and nothing after it: a stream without it was cut short
///
/// What the fields mean stands in estimator/messages.h. Records come in order of delivery. Any bits of a float are
/// kept, also those of no number.
namespace plumbline {

constexpr std::uint32_t kMessageStreamVersion = 1;
constexpr std::uint32_t kMostPayloadBytes = 1U << 28;
constexpr std::uint32_t kMostCalibrationBytes = 1'000'000;

/// The stream's first bytes.
std::string message_stream_header(const Calibration& calibration);

/// A message's record.
/// @throws std::invalid_argument if an image's size is not that of its pixels, or the payload exceeds its bound
std::string message_record(const ImuSample& sample, std::int64_t delivery_ns);
std::string message_record(const CameraFrame& frame, std::int64_t delivery_ns);
std::string message_record(const DepthFrame& frame, std::int64_t delivery_ns);
std::string message_record(const LidarScan& scan, std::int64_t delivery_ns);
std::string message_record(const SensorPayload& payload, std::int64_t delivery_ns);

/// The record that ends a stream.
std::string message_end_record();

/// Reads a stream record by record; no more of it is in memory than one record.
class MessageStreamReader {
 public:
  /// Reads the header.
  /// @param stream  opened in binary mode; must outlive the reader
  /// @param origin  the file's name, for messages
  /// @throws InputError if this is no such stream, one of another version, or its calibration is refused
  MessageStreamReader(std::istream& stream, std::string origin);

  const Calibration& calibration() const { return calibration_; }
  const std::string& calibration_text() const { return calibration_text_; }

  /// The next message, or nothing after the last.
  /// @throws InputError naming the record and its place for a stream that is cut short, goes on after its end, or holds
  /// an unknown or impossible record, and for a delivery time that goes back
  std::optional<SensorMessage> read();

 private:
  [[noreturn]] void fail(const std::string& what) const;
  std::string read_bytes(std::size_t size, const char* what);

  std::istream& stream_;
  std::string origin_;
  std::string calibration_text_;
  Calibration calibration_;
  std::uint64_t place_ = 0;   ///< bytes read
  std::uint64_t record_ = 0;  ///< that is being read, from 1; 0: the header
  std::optional<std::int64_t> delivered_ns_;
  bool ended_ = false;
};

}  // namespace plumbline
