// Executor on the cores of the CPU: items are shared among threads (base/parallel.hpp), and every launch has ended when
// its call returns.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <numeric>
#include <utility>
#include <vector>

#include "base/aligned.hpp"
#include "base/parallel.hpp"

namespace thawslide::exec {

class Cpu {
 public:
  template <class T>
  [[nodiscard]] T* allocate(std::size_t count) {
    return static_cast<T*>(::operator new (count * sizeof(T), std::align_val_t{cache_line}));
  }
  void release(void* memory) { ::operator delete (memory, std::align_val_t{cache_line}); }

  template <class T>
  void copy_in(T* to, const T* from, std::size_t count) {
    std::memcpy(static_cast<void*>(to), from, count * sizeof(T));
  }
  template <class T>
  void copy(T* to, const T* from, std::size_t count) {
    std::memcpy(static_cast<void*>(to), from, count * sizeof(T));
  }
  template <class T>
  void copy_out(T* to, const T* from, std::size_t count) {
    std::memcpy(static_cast<void*>(to), from, count * sizeof(T));
  }

  // Calls work(k) for k = 0 .. count-1, in tasks of Work::of_task items if it has this number.
  template <class Work>
  void for_each(std::size_t count, const Work& work) {
    constexpr std::size_t of_task = [] {
      if constexpr (requires { Work::of_task; }) {
        return std::size_t{Work::of_task};
      } else {
        return std::size_t{256};
      }
    }();
    parallel_for((count + of_task - 1) / of_task, [&](std::size_t task) {
      const std::size_t last = std::min(count, (task + 1) * of_task);
      for (std::size_t k = task * of_task; k < last; ++k) {
        work(k);
      }
    });
  }

  // Stable sort of keys and their values, by digits; those that all keys have in common are skipped.
  void sort(const std::uint64_t* keys, const std::uint32_t* values, std::uint64_t* sorted_keys,
            std::uint32_t* sorted_values, std::size_t count) {
    constexpr int bits = 8;
    constexpr std::uint64_t digit = (std::uint64_t{1} << bits) - 1;
    std::uint64_t differing = 0;
    for (std::size_t k = 0; k < count; ++k) {
      differing |= keys[k] ^ keys[0];
    }
    pairs_.resize(count);
    sorted_.resize(count);
    for (std::size_t k = 0; k < count; ++k) {
      pairs_[k] = {keys[k], values[k]};
    }
    for (int shift = 0; shift < 64; shift += bits) {
      if ((differing >> shift & digit) == 0) {
        continue;
      }
      std::array<std::size_t, digit + 1> first{};
      for (const auto& [key, value] : pairs_) {
        ++first[key >> shift & digit];
      }
      std::exclusive_scan(first.begin(), first.end(), first.begin(), std::size_t{0});
      for (const auto& pair : pairs_) {
        sorted_[first[pair.first >> shift & digit]++] = pair;
      }
      pairs_.swap(sorted_);
    }
    for (std::size_t k = 0; k < count; ++k) {
      sorted_keys[k] = pairs_[k].first;
      sorted_values[k] = pairs_[k].second;
    }
  }

  void sort(const std::uint64_t* keys, std::uint64_t* sorted_keys, std::size_t count) {
    std::copy_n(keys, count, sorted_keys);
    std::sort(sorted_keys, sorted_keys + count);
  }

  // Exclusive prefix sum: sums[k] = numbers[0] + ... + numbers[k-1], for k = 0 .. count-1.
  void sum_before(const std::uint32_t* numbers, std::uint32_t* sums, std::size_t count) {
    std::exclusive_scan(numbers, numbers + count, sums, std::uint32_t{0});
  }

 private:
  std::vector<std::pair<std::uint64_t, std::uint32_t>> pairs_, sorted_;
};

}  // namespace thawslide::exec
