// Sum of parts in an order that is the same on all executors (base/sum_order.hpp). Each thread adds a run; the CPU adds
// the sums of the runs.
#pragma once

#include "base/portability.hpp"
#include "base/sums.hpp"
#include "exec/array.hpp"

namespace thawslide::exec {

template <class Part>
struct SumRun {
  static constexpr std::size_t of_task = 16;
  const Part* parts;
  std::size_t count;
  Part* sums;

  THAWSLIDE_HD void operator()(std::size_t run) const {
    const std::size_t end = count < (run + 1) * parts_of_a_run ? count : (run + 1) * parts_of_a_run;
    Part sum{};
    for (std::size_t k = run * parts_of_a_run; k < end; ++k) {
      sum += parts[k];
    }
    sums[run] = sum;
  }
};

template <class Part, class Executor>
class OrderedSum {
 public:
  explicit OrderedSum(Executor& executor) : executor_(executor) {}

  // Memory for parts, all of which must be written before total() is called.
  [[nodiscard]] Part* parts(std::size_t count) {
    parts_.resize(count);
    return parts_.data();
  }
  [[nodiscard]] Part total() {
    sums_.resize(runs_of(parts_.size()));
    executor_.for_each(sums_.size(), SumRun<Part>{parts_.data(), parts_.size(), sums_.data()});
    Part sum{};
    for (const Part& of_run : sums_.get()) {
      sum += of_run;
    }
    return sum;
  }

 private:
  Executor& executor_;
  Array<Part, Executor> parts_{executor_}, sums_{executor_};
};

}  // namespace thawslide::exec
