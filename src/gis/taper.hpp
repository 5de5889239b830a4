// Tapers the edge of a thickness.
//
// The thickness becomes the mean of that about each point, weighed by 1 + cos(2 pi d / w) for d < w / 2 along each
// axis: a straight edge becomes a ramp of the width w with a smooth beginning and end. The weights sum to 1, so that
// the volume stays what it is as long as the raster has zeros to half the width on every side.
#pragma once

#include "base/raster.hpp"

namespace thawslide::gis {

// Points on each side that a width [m] reaches.
[[nodiscard]] int taper_reach(double width, double cell);

[[nodiscard]] Raster tapered(const Raster& thickness, double width);

}  // namespace thawslide::gis
