// The depth of the erodible bed of a case, from a raster.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"
#include "gis/dem.hpp"

namespace thawslide::gis {

// At the points of the ground; empty where no raster gives it. Throws UserError for a raster that does not know the
// depth all over the domain, or holds one below 0 or above grid.cell.
[[nodiscard]] Raster load_bed_depth(const config::Case& parameters, const Dem& ground,
                                    std::vector<std::string>& warnings);

}  // namespace thawslide::gis
