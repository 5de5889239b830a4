// Changes that make a case a trial: cells of twice the size, with the steps and maps that belong to them.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

// Factor of cells, steps and map cells of a trial.
inline constexpr double trial_factor = 2.0;

// These changes as `--set` texts.
[[nodiscard]] inline std::vector<std::string> coarse_changes(const Case& parameters) {
  std::vector<std::string> changes{fmt::format("grid.cell={}", trial_factor * parameters.grid.cell)};
  if (was_given(parameters, "time.step")) {  // otherwise adaptive steps have no upper limit
    changes.push_back(fmt::format("time.step={}", trial_factor * parameters.time.step));
  }
  if (parameters.maps.cell > 0.0) {
    changes.push_back(fmt::format("maps.cell={}", trial_factor * parameters.maps.cell));
  }
  return changes;
}

}  // namespace thawslide::config
