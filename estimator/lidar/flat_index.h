#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace plumbline {

/// Packs a cell of an integer grid (20 bits an axis, a million cells) and a small label (4 bits) into a key.
inline std::uint64_t pack_cell(const Eigen::Vector3i& cell, int label = 0) {
  constexpr std::uint64_t kMask = (1ULL << 20) - 1;
  const auto bits = [](int v) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(v)) & kMask; };
  return (static_cast<std::uint64_t>(label) << 60) | (bits(cell.x()) << 40) | (bits(cell.y()) << 20) | bits(cell.z());
}

/// The cell of a grid that holds a point.
inline Eigen::Vector3i cell_of(const Eigen::Vector3d& position, double cells_per_metre) {
  return (position * cells_per_metre).array().floor().cast<int>();
}

/// A hash from 64-bit keys to positions in somebody's array: open addressing in one block, so that a look-up neither
/// allocates nor follows pointers. It cannot be iterated, so that no result can depend on the hash's order.
class FlatIndex {
 public:
  static constexpr std::uint32_t kAbsent = 0xffffffffU;

  explicit FlatIndex(std::size_t expected = 16) { rehash(expected); }

  std::uint32_t find(std::uint64_t key) const {
    for (std::size_t slot = hash(key) & mask_;; slot = (slot + 1) & mask_) {
      if (slots_[slot].value == kAbsent || slots_[slot].key == key) return slots_[slot].value;
    }
  }

  /// The value under a key; where there is none, `value` is put there first.
  std::uint32_t find_or_insert(std::uint64_t key, std::uint32_t value) {
    if (2 * (size_ + 1) > slots_.size()) rehash(2 * size_ + 2);
    std::size_t slot = hash(key) & mask_;
    while (slots_[slot].value != kAbsent && slots_[slot].key != key) slot = (slot + 1) & mask_;
    if (slots_[slot].value == kAbsent) {
      slots_[slot] = {key, value};
      ++size_;
    }
    return slots_[slot].value;
  }

  void clear() {
    slots_.assign(slots_.size(), {});
    size_ = 0;
  }

 private:
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t value = kAbsent;
  };

  // splitmix64's finaliser without its last round: neighbouring cells land far apart.
  static std::size_t hash(std::uint64_t key) {
    key = (key ^ (key >> 30)) * 0xbf58476d1ce4e5b9ULL;
    key = (key ^ (key >> 27)) * 0x94d049bb133111ebULL;
    return static_cast<std::size_t>(key ^ (key >> 31));
  }

  void rehash(std::size_t expected) {
    std::size_t capacity = 16;
    while (capacity < 2 * expected) capacity *= 2;
    std::vector<Slot> old(capacity);
    old.swap(slots_);
    mask_ = capacity - 1;
    size_ = 0;
    for (const Slot& slot : old) {
      if (slot.value != kAbsent) find_or_insert(slot.key, slot.value);
    }
  }

  std::vector<Slot> slots_;
  std::size_t mask_ = 0;
  std::size_t size_ = 0;
};

}  // namespace plumbline
