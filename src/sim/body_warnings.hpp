// What is most likely not meant of bodies as they stand at t = 0.
#pragma once

#include <string>
#include <vector>

#include "sim/body_figures.hpp"

namespace thawslide::sim {

// Each with the place of what it is about, what was found and what to do.
[[nodiscard]] std::vector<std::string> body_warnings(const config::Case& parameters,
                                                     const std::vector<BodyFigures>& bodies);

}  // namespace thawslide::sim
