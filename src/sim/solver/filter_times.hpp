// Times at which velocities are filtered (mpm/velocity_filter.hpp).
#pragma once

#include <cmath>

#include "config/case.hpp"

namespace thawslide::sim {

// True if the step of dt from `time` [s] reaches or passes a multiple of the interval. Round-off of the time has no
// effect.
[[nodiscard]] inline bool filters_in_step(const config::Case& parameters, double time, double dt) {
  const double interval = parameters.mechanics.fmpm_interval;
  const auto intervals = [&](double until) { return std::floor(until / interval * (1.0 + 1e-12)); };
  return intervals(time + dt) > intervals(time);
}

}  // namespace thawslide::sim
