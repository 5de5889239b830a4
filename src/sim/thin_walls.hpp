// Walls of the terrain that are thinner than a cell: contact does not separate the material on their two sides.
#pragma once

#include <string>

#include "config/case.hpp"
#include "config/site.hpp"

namespace thawslide::sim {

// Checks a profile or a DEM within the domain. A wall is more than one cell higher than the ground half a cell away on
// both sides. Returns an empty string if there is none.
[[nodiscard]] std::string warning_of_thin_walls(const config::Case& parameters, const config::Site& site);

}  // namespace thawslide::sim
