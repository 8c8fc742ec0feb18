#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/formats/point_cloud_file.h"

/// What PLY and PCD have in common: points as records of named numbers, as text or as bytes.
namespace plumbline {

enum class NumberType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kInt64, kUint64, kFloat32, kFloat64 };
std::size_t size_of(NumberType type);

struct RecordField {
  std::string name;
  NumberType type = NumberType::kFloat32;
  std::size_t count = 1;
};

/// Finds the fields that are used among those of a record.
class PointRecord {
 public:
  static constexpr std::size_t kMostBytes = 65'536;

  /// @throws std::invalid_argument without x, y and z, or if it is larger than kMostBytes
  explicit PointRecord(const std::vector<RecordField>& fields);

  std::size_t bytes() const { return bytes_; }      ///< of a binary record
  std::size_t numbers() const { return numbers_; }  ///< of a text record
  bool has_normals() const { return used_[kNormalX] && used_[kNormalY] && used_[kNormalZ]; }

  CloudPoint from_bytes(const char* record, bool swapped) const;
  /// The same where each field's values of all points follow each other.
  CloudPoint from_columns(const char* data, std::size_t points, std::size_t index) const;
  CloudPoint from_numbers(const std::vector<double>& numbers) const;

 private:
  enum Role { kX, kY, kZ, kNormalX, kNormalY, kNormalZ, kIntensity, kRoles };
  struct Place {
    std::size_t offset = 0;  // bytes before it in a record
    std::size_t index = 0;   // numbers before it in a record
    NumberType type = NumberType::kFloat32;
  };

  template <typename Read>
  CloudPoint assemble(Read read) const;

  std::array<std::optional<Place>, kRoles> used_;
  std::size_t bytes_ = 0;
  std::size_t numbers_ = 0;
};

}  // namespace plumbline
