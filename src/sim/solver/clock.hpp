// Time of a run.
#pragma once

#include <cmath>
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

// True if the step of dt from `time` [s] reaches or passes a multiple of mechanics.fmpm_interval, at which velocities
// are filtered (mpm/velocity_filter.hpp). Round-off of the time has no effect.
[[nodiscard]] inline bool filters_in_step(const config::Case& parameters, double time, double dt) {
  const double interval = parameters.mechanics.fmpm_interval;
  const auto intervals = [&](double until) { return std::floor(until / interval * (1.0 + 1e-12)); };
  return intervals(time + dt) > intervals(time);
}

}  // namespace thawslide::sim
