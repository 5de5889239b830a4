// Release of one body: its thickness and other mapped fields, at the points of the ground.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"
#include "config/site.hpp"
#include "gis/dem.hpp"
#include "gis/polygons.hpp"

namespace thawslide::gis {

// Release and its area.
struct LoadedRelease {
  config::Release release;
  Polygons polygons;  // covered area; for a raster, the cells around its points
  Raster fraction;    // covered fraction of each point's cell
  Raster spread;      // the same, distributed by the taper like the thickness
};

// `ground`: the original DEM, before excavation. Appends warnings.
[[nodiscard]] LoadedRelease load_release(const config::Case& parameters, const std::string& body, const Dem& ground,
                                         std::vector<std::string>& warnings);

}  // namespace thawslide::gis
