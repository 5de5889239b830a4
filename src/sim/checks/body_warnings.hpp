// Warnings about initial states of bodies that are probably unintended.
#pragma once

#include <string>
#include <vector>

#include "sim/checks/body_figures.hpp"

namespace thawslide::sim {

// Each warning specifies the location in the case, the finding and the remedy.
[[nodiscard]] std::vector<std::string> body_warnings(const config::Case& parameters,
                                                     const std::vector<BodyFigures>& bodies);

}  // namespace thawslide::sim
