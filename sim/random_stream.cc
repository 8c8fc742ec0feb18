#include "sim/random_stream.h"

#include <cmath>

namespace plumbline {
namespace {
std::uint64_t rotate_left(std::uint64_t x, int k) { return (x << k) | (x >> (64 - k)); }
}  // namespace

// splitmix64's finaliser (Steele, Lea, Flood 2014).
std::uint64_t mix_bits(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15ULL;
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31);
}

std::uint64_t derive_seed(std::uint64_t seed, std::string_view name) {
  std::uint64_t hash = mix_bits(seed);
  for (const char c : name) hash = mix_bits(hash ^ static_cast<unsigned char>(c));
  return hash;
}

RandomStream::RandomStream(std::uint64_t seed, std::string_view name) {
  std::uint64_t word = derive_seed(seed, name);
  for (auto& s : state_) s = word = mix_bits(word);
}

// xoshiro256** (Blackman, Vigna 2018).
std::uint64_t RandomStream::bits() {
  const std::uint64_t result = rotate_left(state_[1] * 5, 7) * 9;
  const std::uint64_t t = state_[1] << 17;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= t;
  state_[3] = rotate_left(state_[3], 45);
  return result;
}

double RandomStream::uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }

double RandomStream::uniform(double low, double high) { return low + (high - low) * uniform(); }

// Marsaglia's polar method.
double RandomStream::gaussian() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  double x = 0.0;
  double y = 0.0;
  double r = 0.0;
  do {
    x = uniform(-1.0, 1.0);
    y = uniform(-1.0, 1.0);
    r = x * x + y * y;
  } while (r >= 1.0 || r == 0.0);
  const double scale = std::sqrt(-2.0 * std::log(r) / r);
  spare_ = y * scale;
  has_spare_ = true;
  return x * scale;
}

int RandomStream::integer(int low, int high) {
  return low + static_cast<int>(uniform() * (static_cast<double>(high) - low + 1.0));
}

}  // namespace plumbline
