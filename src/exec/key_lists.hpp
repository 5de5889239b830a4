// Ascending lists of keys.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/portability.hpp"
#include "exec/array.hpp"

namespace thawslide::exec {

inline constexpr std::int32_t absent = -1;

// Sets a mark to which several threads may write the same value.
THAWSLIDE_HD inline void set_mark(std::uint32_t& mark, std::uint32_t value) {
#ifdef __CUDA_ARCH__
  mark = value;
#else
  std::atomic_ref(mark).store(value, std::memory_order_relaxed);
#endif
}

template <class T>
struct Fill {
  T* numbers;
  T number;

  THAWSLIDE_HD void operator()(std::size_t k) const { numbers[k] = number; }
};

// Lower bound: first place in [first, last) of an ascending list whose entry is not less than the key.
THAWSLIDE_HD inline std::size_t first_not_below(const std::uint64_t* keys, std::size_t first, std::size_t last,
                                                std::uint64_t key) {
  while (first < last) {
    const std::size_t middle = first + (last - first) / 2;
    if (keys[middle] < key) {
      first = middle + 1;
    } else {
      last = middle;
    }
  }
  return first;
}
THAWSLIDE_HD inline std::int32_t index_of_key(const std::uint64_t* keys, std::size_t count, std::uint64_t key) {
  const std::size_t index = first_not_below(keys, 0, count, key);
  return index < count && keys[index] == key ? static_cast<std::int32_t>(index) : absent;
}

// Index map from current to former keys, to reuse earlier results of CPU queries: index of each key in the list
// `former`, or absent. Both lists ascend.
inline std::vector<std::int32_t> index_map(const std::vector<std::uint64_t>& former,
                                           const std::vector<std::uint64_t>& keys) {
  std::vector<std::int32_t> indices(keys.size(), absent);
  std::size_t at = 0;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    while (at < former.size() && former[at] < keys[k]) {
      ++at;
    }
    if (at < former.size() && former[at] == keys[k]) {
      indices[k] = static_cast<std::int32_t>(at);
    }
  }
  return indices;
}

// Marks the places of an ascending list at which a new value begins, ignoring bits below `shift`.
struct MarkFirst {
  const std::uint64_t* keys;
  int shift;
  std::uint32_t* is_first;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    is_first[k] = k == 0 || keys[k] >> shift != keys[k - 1] >> shift ? 1 : 0;
  }
};

// Gathers the values at marked places. number: count of marked places before each place.
struct KeepFirst {
  const std::uint64_t* keys;
  int shift;
  const std::uint32_t *is_first, *number;
  std::uint64_t* found;
  std::uint32_t* index;  // null: not required

  THAWSLIDE_HD void operator()(std::size_t k) const {
    if (is_first[k] != 0) {
      found[number[k]] = keys[k] >> shift;
      if (index != nullptr) {
        index[number[k]] = static_cast<std::uint32_t>(k);
      }
    }
  }
};

template <class Executor>
class UniqueKeys {
 public:
  explicit UniqueKeys(Executor& executor) : executor_(executor) {}

  // Finds the unique keys of a list, ignoring bits below `shift`, and optionally the places at which they begin.
  void find(const Array<std::uint64_t, Executor>& keys, int shift, Array<std::uint64_t, Executor>& found,
            Array<std::uint32_t, Executor>* indices) {
    const std::size_t count = keys.size();
    is_first_.resize(count);
    number_.resize(count);
    executor_.for_each(count, MarkFirst{keys.data(), shift, is_first_.data()});
    executor_.sum_before(is_first_.data(), number_.data(), count);
    const std::size_t different = count > 0 ? number_.get(count - 1) + is_first_.get(count - 1) : 0;
    found.resize(different);
    if (indices != nullptr) {
      indices->resize(different);
    }
    executor_.for_each(count, KeepFirst{keys.data(), shift, is_first_.data(), number_.data(), found.data(),
                                        indices != nullptr ? indices->data() : nullptr});
  }

  // For the last list, by place: whether a key begins there, and how many keys begin before.
  [[nodiscard]] const std::uint32_t* is_first() const { return is_first_.data(); }
  [[nodiscard]] const std::uint32_t* number() const { return number_.data(); }

 private:
  Executor& executor_;
  Array<std::uint32_t, Executor> is_first_{executor_}, number_{executor_};
};

}  // namespace thawslide::exec
