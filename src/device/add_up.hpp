// Sums over tiles and blocks, in the same fixed order as on the CPU (base/sum_order.hpp).
#pragma once

#include <cstddef>

#include "base/portability.hpp"
#include "base/sums.hpp"

namespace thawslide::device {

// One thread group adds up `of_a_group` parts: its threads load up to `parts_of_a_run` of them at a time into shared
// memory, and one thread adds them in order.
template <class Sum>
struct AddUp {
  static constexpr std::size_t at_a_time = parts_of_a_run, bytes = at_a_time * sizeof(Sum);

  const Sum* parts;
  std::size_t count, of_a_group;  // numbers of parts
  Sum* sums;                      // by group

  template <class Group>
  THAWSLIDE_HD void operator()(Group& group, std::size_t number) const {
    auto* fetched = reinterpret_cast<Sum*>(group.shared());
    Sum* sum = sums + number;
    group.each(1, [sum](std::size_t /*k*/) { *sum = {}; });
    const std::size_t end = count < (number + 1) * of_a_group ? count : (number + 1) * of_a_group;
    for (std::size_t first = number * of_a_group; first < end; first += at_a_time) {
      const std::size_t here = end - first < at_a_time ? end - first : at_a_time;
      group.each(here, [this, first, fetched](std::size_t k) { fetched[k] = parts[first + k]; });
      group.barrier();
      group.each(1, [sum, here, fetched](std::size_t /*k*/) {
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

// Buffer size, in sums, that add_up needs for this number of parts.
constexpr std::size_t partial_sum_count(std::size_t parts) { return parts + runs_of(parts) + 1; }

// Sums the first `parts` entries of `sums`, a buffer of partial_sum_count(parts) entries. Returns a pointer to the
// result within the buffer.
template <class Backend, class Sum>
Sum* add_up(Backend& backend, Sum* sums, std::size_t parts) {
  using PartialSums = AddUp<Sum>;
  Sum* of_runs = sums + parts;
  const std::size_t runs = runs_of(parts);
  backend.for_groups(runs, PartialSums::at_a_time, PartialSums::bytes,
                     PartialSums{sums, parts, parts_of_a_run, of_runs});
  if (runs == 1) {
    return of_runs;
  }
  backend.for_groups(1, PartialSums::at_a_time, PartialSums::bytes, PartialSums{of_runs, runs, runs, of_runs + runs});
  return of_runs + runs;
}

}  // namespace thawslide::device
