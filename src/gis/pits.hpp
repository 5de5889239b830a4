// DEM points with undeclared no-data values, and rasters that are no DEM.
#pragma once

#include <string>

#include "base/raster.hpp"

namespace thawslide::gis {

// Warning about patches of one value, such as 0, within ground of a very different height; empty if there are none. A
// patch counts if all adjacent ground is more than 100 m higher or lower, with a slope steeper than 80 degrees: no lake
// or sea has such a shore all around. A single point counts if it is 0.
[[nodiscard]] std::string pits_warning(const std::string& file, const Raster& ground);

// Warning about a raster that is 0 along its edge and not inside, as a thickness is; empty if it is not.
[[nodiscard]] std::string thickness_warning(const std::string& file, const Raster& ground);

}  // namespace thawslide::gis
