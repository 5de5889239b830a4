// Time of a run.
#pragma once

#include <cstdint>

#include "config/case.hpp"

namespace thawslide::sim {

struct Clock {
  double time = 0.0, last_step = 0.0;  // [s]
  std::int64_t step_number = 0;
  // Fixed steps of one size: that size, and the time and step number when the first of them began. They are counted
  // from there, so round-off does not accumulate.
  struct {
    double step = 0.0, from_time = 0.0;
    std::int64_t from_number = 0;
  } fixed;

  // Advances by a step of dt [s].
  void advance(double dt, const config::Time& times) {
    ++step_number;
    last_step = dt;
    if (times.stepping != config::Stepping::fixed || dt != times.step) {
      fixed = {};
      time += dt;
      return;
    }
    if (dt != fixed.step) {
      fixed = {dt, time, step_number - 1};
    }
    time = fixed.from_time + static_cast<double>(step_number - fixed.from_number) * dt;
  }
};

}  // namespace thawslide::sim
