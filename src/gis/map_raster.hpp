// Rasters beside the DEM: a thickness, the surface before the slide, a temperature.
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
  std::string key;  // that named the file
  std::string file;
  Quantity quantity;                   // of its values
  std::string crs;                     // of the ground
  std::optional<Rectangle> area;       // where it is needed, in the ground's coordinates; without one all of it is read
  std::string reason = "the release";  // what it is needed for there
};

// Its reference system is the one that the file tells, or the ground's where the file tells none, or one that its
// numbers cannot be in: that is noted. Throws UserError where it does not reach the area at all.
[[nodiscard]] Raster read_map(const config::Case& parameters, const MapRequest& request,
                              std::vector<std::string>& warnings);

}  // namespace thawslide::gis
