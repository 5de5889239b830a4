// Missing numbers of a raster.
#pragma once

#include "base/raster.hpp"

namespace thawslide {

// Gives each point without data (NaN) the value of the nearest point that has one; at least one has. Time and memory
// are proportional to the number of points, however large the holes.
void fill_from_nearest_known(Raster& raster);

}  // namespace thawslide
