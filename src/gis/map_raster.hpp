// Rasters other than the DEM: a thickness, the surface before release, a temperature.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/raster.hpp"
#include "config/case.hpp"
#include "gis/rectangle.hpp"
#include "gis/value_unit.hpp"

namespace thawslide::gis {

struct MapRequest {
  std::string key;  // key that named the file
  std::string file;
  Quantity quantity;                   // of its values
  std::string crs;                     // of the ground
  std::optional<Rectangle> area;       // required area in the ground's coordinates; empty: the whole raster
  std::string reason = "the release";  // purpose in that area
  std::string heights = {};            // vertical reference system of the DEM, for elevations
};

// The reference system is that of the file. It is that of the ground, with a warning, if the file has none, or one that
// its coordinates cannot be in. Throws UserError if the raster does not overlap the area.
[[nodiscard]] Raster read_map(const config::Case& parameters, const MapRequest& request,
                              std::vector<std::string>& warnings);

}  // namespace thawslide::gis
