// Storage aligned to cache lines.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace thawslide {

inline constexpr std::size_t cache_line = 64;

template <class T>
struct AlignedAllocator {
  using value_type = T;
  AlignedAllocator() = default;
  template <class U>
  AlignedAllocator(const AlignedAllocator<U>& /*other*/) noexcept {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new (n * sizeof(T), std::align_val_t{cache_line})); }
  void deallocate(T* pointer, std::size_t /*n*/) noexcept { ::operator delete (pointer, std::align_val_t{cache_line}); }
  template <class U>
  bool operator==(const AlignedAllocator<U>& /*other*/) const noexcept {
    return true;
  }
};

// Resizes to `count` items with little spare capacity: std::vector would double its capacity for one additional item.
template <class Vector>
void resize_sparingly(Vector& items, std::size_t count) {
  if (count > items.capacity()) {
    items.reserve(count + count / 8);
  }
  items.resize(count);
}

template <class T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

}  // namespace thawslide
