#pragma once

#include <array>
#include <cstddef>

namespace plumbline {

/// Light of one firing that comes back from about one distance.
struct LidarEcho {
  double range_m = 0.0;
  double strength = 0.0;  ///< see LidarSignal
  double spread_m = 0.0;  ///< standard deviation of the ranges it comes from
};

/// The few echoes of a firing.
class LidarEchoes {
 public:
  static constexpr std::size_t kMost = 16;

  void add(const LidarEcho& echo) {
    if (size_ < kMost) echoes_[size_++] = echo;
  }
  void clear() { size_ = 0; }
  std::size_t size() const { return size_; }
  LidarEcho* begin() { return echoes_.data(); }
  LidarEcho* end() { return echoes_.data() + size_; }
  const LidarEcho* begin() const { return echoes_.data(); }
  const LidarEcho* end() const { return echoes_.data() + size_; }
  const LidarEcho& operator[](std::size_t i) const { return echoes_[i]; }

  /// Joins echoes that the receiver cannot tell apart, those within resolution_m of a neighbour: strengths add up, the
  /// range is their mean weighted by strength. Leaves them in order of range.
  void merge(double resolution_m);

 private:
  std::array<LidarEcho, kMost> echoes_;
  std::size_t size_ = 0;
};

}  // namespace plumbline
