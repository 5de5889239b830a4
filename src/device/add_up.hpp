// Sums of what tiles and blocks sum, one after the other: always in the same order.
#pragma once

#include <cstddef>

#include "base/portability.hpp"

namespace thawslide::device {

// One group of threads: it fetches some parts at a time, which a single thread adds up.
template <class Sum>
struct AddUp {
  static constexpr std::size_t at_a_time = 128, bytes = at_a_time * sizeof(Sum);

  const Sum* parts;
  std::size_t count;
  Sum* sum;

  template <class Group>
  THAWSLIDE_HD void operator()(Group& group, std::size_t /*k*/) const {
    auto* fetched = reinterpret_cast<Sum*>(group.shared());
    group.each(1, [this](std::size_t /*k*/) { *sum = {}; });
    for (std::size_t first = 0; first < count; first += at_a_time) {
      const std::size_t here = count - first < at_a_time ? count - first : at_a_time;
      group.each(here, [this, first, fetched](std::size_t k) { fetched[k] = parts[first + k]; });
      group.barrier();
      group.each(1, [this, here, fetched](std::size_t /*k*/) {
        Sum all = *sum;
        for (std::size_t k = 0; k < here; ++k) {
          all += fetched[k];
        }
        *sum = all;
      });
      group.barrier();
    }
  }
};

template <class Backend, class Sum>
void add_up(Backend& backend, const Sum* parts, std::size_t count, Sum* sum) {
  using Adding = AddUp<Sum>;
  backend.for_groups(1, Adding::at_a_time, Adding::bytes, Adding{parts, count, sum});
}

}  // namespace thawslide::device
