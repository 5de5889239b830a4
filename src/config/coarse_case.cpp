#include "config/coarse_case.hpp"

#include <fmt/format.h>

namespace thawslide::config {

std::vector<std::string> coarse_changes(const Case& parameters) {
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
