// Warnings about a DEM: no-data points, undeclared no-data values, and rasters that are no DEM.
#pragma once

#include <string>
#include <vector>

#include "base/raster.hpp"
#include "config/case.hpp"
#include "config/site.hpp"

namespace thawslide::gis {

// Warning about no-data points within the domain: their number, the one nearest to a release, and the effect on a slide
// that reaches them; empty if there are none.
[[nodiscard]] std::string holes_warning(const config::Case& parameters, const config::Site& site);

// Warning for each probe whose point, or all of whose corners, have no terrain data.
[[nodiscard]] std::vector<std::string> probes_in_holes(const config::Site& site);

// Warning about patches of one value, such as 0, within ground of a very different height; empty if there are none. A
// patch counts if all adjacent ground is more than 100 m higher or lower, with a slope steeper than 80 degrees: no lake
// or sea has such a shore all around. A single point counts if it is 0.
[[nodiscard]] std::string pits_warning(const std::string& file, const Raster& ground);

// Warning about a raster that is 0 along its edge and not inside, as a thickness is; empty if it is not.
[[nodiscard]] std::string thickness_warning(const std::string& file, const Raster& ground);

}  // namespace thawslide::gis
