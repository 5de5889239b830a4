// Tapering of the edge of a thickness.
//
// The thickness becomes the mean around each point, with weights 1 + cos(2 pi d / w) for d < w / 2 along each axis: a
// straight edge becomes a ramp of width w with smooth ends. The weights sum to 1, so the volume is conserved if the
// raster has zeros within half the width of every side.
#pragma once

#include "base/raster.hpp"

namespace thawslide::gis {

// Number of points on each side within the reach of a width [m].
[[nodiscard]] int taper_reach(double width, double cell);

[[nodiscard]] Raster tapered(const Raster& thickness, double width);

}  // namespace thawslide::gis
