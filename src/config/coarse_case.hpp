// Changes that make a case a trial: cells of twice the size, with the steps and maps that belong to them.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

// Factor of cells, steps and map cells of a trial.
inline constexpr double trial_factor = 2.0;

// These changes as `--set` texts.
[[nodiscard]] std::vector<std::string> coarse_changes(const Case& parameters);

}  // namespace thawslide::config
