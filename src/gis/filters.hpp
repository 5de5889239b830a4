// Filters of rasters: smoothing of a DEM, and tapering of the edge of a thickness.
#pragma once

#include "base/raster.hpp"

namespace thawslide::gis {

inline constexpr double smoothing_reach = 4.0;  // standard deviations

// Replaces the height at each point with data by that of the best-fit plane through the surrounding known points (local
// linear regression; Fan and Gijbels 1996). The weights are exp(-d^2 / (2 s^2)), with the distance d along both axes
// and the standard deviation s [m], up to d = 4 s. If all surrounding points are known, this is the Gaussian mean. At
// the edge of the known area a mean would tilt a slope, but the plane does not. No-data points remain.
//
// Planes are reproduced exactly. The mean height is conserved if the ground is plane within the filter's reach of the
// edge.
[[nodiscard]] Raster smoothed(const Raster& raster, double standard_deviation);

// Number of points on each side within the reach of a width [m].
[[nodiscard]] int taper_reach(double width, double cell);

// Mean of a thickness around each point, with weights 1 + cos(2 pi d / w) for d < w / 2 along each axis: a straight
// edge becomes a ramp of width w with smooth ends. The weights sum to 1, so the volume is conserved if the raster has
// zeros within half the width of every side.
[[nodiscard]] Raster tapered(const Raster& thickness, double width);

}  // namespace thawslide::gis
