// Walls of the terrain that are thinner than a cell: contact does not part the matter on their two sides.
#pragma once

#include <string>

#include "config/case.hpp"
#include "config/site.hpp"

namespace thawslide::sim {

// Of a profile or a DEM within the domain. A wall is higher than a cell above the ground half a cell away on both
// sides. Empty: there is none.
[[nodiscard]] std::string warning_of_thin_walls(const config::Case& parameters, const config::Site& site);

}  // namespace thawslide::sim
