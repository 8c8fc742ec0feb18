#pragma once

#include <cstdint>
#include <string_view>

namespace plumbline {

/// A stream of random draws derived from a seed and a stable name, so that adding a source changes no other source.
/// The draws are our own arithmetic: std distributions differ between standard libraries.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name);

  std::uint64_t bits();
  double uniform();                         ///< [0, 1)
  double uniform(double low, double high);  ///< [low, high)
  double gaussian();                        ///< mean 0, standard deviation 1
  int integer(int low, int high);           ///< low..high, both included

 private:
  std::uint64_t state_[4];
  double spare_ = 0.0;
  bool has_spare_ = false;
};

/// A well-mixed 64-bit hash, for draws that depend on a place (a texel, a pixel) and not on an order.
std::uint64_t mix_bits(std::uint64_t value);

/// The seed of a source: mixes a seed with a stable name.
std::uint64_t derive_seed(std::uint64_t seed, std::string_view name);

}  // namespace plumbline
