// Hash table from 64-bit keys to indices: open addressing, linear probing, no removal.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace thawslide {

class KeyIndex {
 public:
  static constexpr std::int32_t absent = -1;

  [[nodiscard]] std::size_t size() const { return count_; }

  // Removes all keys but keeps the memory.
  void clear() {
    std::fill(slots_.begin(), slots_.end(), Slot{});
    count_ = 0;
  }

  // Index stored for the key, or absent.
  [[nodiscard]] std::int32_t find(std::uint64_t key) const {
    if (slots_.empty()) {
      return absent;
    }
    for (std::size_t k = hash(key);; ++k) {
      const Slot& slot = slots_[k & (slots_.size() - 1)];
      if (slot.index == absent || slot.key == key) {
        return slot.index;
      }
    }
  }

  // Index of the key; a new key gets the index size().
  std::int32_t insert(std::uint64_t key) {
    if (2 * (count_ + 1) > slots_.size()) {
      grow();
    }
    for (std::size_t k = hash(key);; ++k) {
      Slot& slot = slots_[k & (slots_.size() - 1)];
      if (slot.index == absent) {
        slot = Slot{key, static_cast<std::int32_t>(count_++)};
        return slot.index;
      }
      if (slot.key == key) {
        return slot.index;
      }
    }
  }

 private:
  struct Slot {
    std::uint64_t key = 0;
    std::int32_t index = absent;
  };

  static std::size_t hash(std::uint64_t key) {
    key ^= key >> 31;
    key *= 0x9e3779b97f4a7c15ULL;  // golden ratio, Knuth's multiplicative hashing
    return static_cast<std::size_t>(key >> 20);
  }

  void grow() {
    std::vector<Slot> old = std::move(slots_);
    slots_.assign(old.empty() ? 64 : 2 * old.size(), Slot{});
    for (const Slot& moved : old) {
      if (moved.index != absent) {
        std::size_t k = hash(moved.key);
        while (slots_[k & (slots_.size() - 1)].index != absent) {
          ++k;
        }
        slots_[k & (slots_.size() - 1)] = moved;
      }
    }
  }

  std::vector<Slot> slots_;
  std::size_t count_ = 0;
};

}  // namespace thawslide
