// Filling of missing values in a raster.
#pragma once

#include "base/raster.hpp"

namespace thawslide {

// Sets each point without data (NaN) to the value of the nearest point with data; at least one must have data. Time and
// memory are proportional to the number of points, independent of the size of the gaps.
void fill_from_nearest_known(Raster& raster);

}  // namespace thawslide
