// Lower side of the domain. On terrain, cells begin at the ground.
#pragma once

#include <string>

#include "config/site.hpp"

namespace thawslide::sim {

// Elevation of the lower side of the domain [m]: that of the case, or a cell below the lowest terrain. On terrain,
// cells begin at the ground, and a higher corner would only exclude the slide from low ground.
[[nodiscard]] double bottom_of_domain(const config::Case& parameters, const config::Site& site);
// States that the elevation of the case has no effect; empty unless it is above the lowest terrain.
[[nodiscard]] std::string note_of_bottom(const config::Case& parameters, const config::Site& site);

}  // namespace thawslide::sim
