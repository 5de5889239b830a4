// The release of one body: its thickness and what else maps tell of it, at the points of the ground.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"
#include "config/site.hpp"
#include "gis/dem.hpp"
#include "gis/polygons.hpp"

namespace thawslide::gis {

// A release, and where it lies.
struct LoadedRelease {
  config::Release release;
  Polygons polygons;  // the area it covers; of a raster the cells about its points
  Raster share;       // of each point's cell that it covers
  Raster spread;      // the same, handed to the points about it by the taper as the thickness is
};

// `ground` as the DEM has it, before anything is cut out of it. Adds to the notes.
[[nodiscard]] LoadedRelease load_release(const config::Case& parameters, const std::string& body, const Dem& ground,
                                         std::vector<std::string>& warnings);

}  // namespace thawslide::gis
