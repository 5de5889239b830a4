// A Gaussian filter over a raster.
#pragma once

#include "base/raster.hpp"

namespace thawslide::gis {

inline constexpr double smoothing_reach = 4.0;  // standard deviations

// At each point with data the height there of the plane that fits the known points about it best, each weighed by
// exp(-d^2 / (2 s^2)) with its distance d along both axes and the standard deviation s [m], to four of it (local linear
// regression; Fan and Gijbels 1996). Where all points about one are known this is the Gaussian mean; at the edge of
// what is known a mean would tilt a slope, and the plane does not. Points without data stay so.
//
// Planes stay as they are. The mean height stays where the ground is plane within the reach of the edge.
[[nodiscard]] Raster smoothed(const Raster& raster, double standard_deviation);

}  // namespace thawslide::gis
