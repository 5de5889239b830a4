// Release in stages: times until which bodies are held.
#pragma once

#include <vector>

#include "config/site.hpp"

namespace thawslide::sim {

// Release times of a number of bodies [s], in the order of the case; 0 for those that the case does not contain. Empty
// if all bodies are released at the start.
[[nodiscard]] std::vector<double> release_times(const config::Case& parameters, const config::Site& site,
                                                std::size_t bodies);

}  // namespace thawslide::sim
