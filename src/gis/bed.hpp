// Depth of the erodible bed of a case, from a raster.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"
#include "gis/dem.hpp"

namespace thawslide::gis {

// Values at the points of the ground; empty if no raster is specified. Throws UserError for a raster with no data in
// the domain, or with a depth below 0 or above grid.cell.
[[nodiscard]] Raster load_bed_depth(const config::Case& parameters, const Dem& ground,
                                    std::vector<std::string>& warnings);

}  // namespace thawslide::gis
