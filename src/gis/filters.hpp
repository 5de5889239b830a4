// Filters of rasters: smoothing of a DEM, tapering of the edge of a thickness, and resampling at new points. Only the
// requested points are computed, from a sufficiently large part of the file, so cropping does not change a value.
//
// Along each axis, a resampled value is a weighted sum of old ones. If the new spacing is at most the old one, values
// are interpolated linearly. Points with a larger spacing get the mean of the linear interpolation over an interval of
// the new spacing, centred on each. Both reproduce a plane exactly.
#pragma once

#include <functional>
#include <vector>

#include "base/raster.hpp"
#include "gis/point_window.hpp"

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

// Weights of the old points first, first + 1, ... for a new one along an axis.
struct AxisWeights {
  int first = 0;
  std::vector<double> weights;
};

// For a new point at a position, and with a cell width, in units of the old spacing; count: number of old points.
using WeightsOfPoint = std::function<AxisWeights(double coordinate, double width, int count)>;

// Sums at each point of a layout, over old points with data: of weights times values, and of weights.
struct WeightedSums {
  Raster values, weights;
};
[[nodiscard]] WeightedSums weighted_sums(const Raster& raster, const Raster& layout, const WeightsOfPoint& weights_of);

// Value over weight if the weight exceeds `least`; otherwise NaN.
[[nodiscard]] Raster means_of(WeightedSums sums, double least);

// Points `distance` metres apart that fit in a whole raster: from its first point if they are interpolated, from half a
// distance beyond it if they are means. No columns or rows if none fit.
[[nodiscard]] Raster resampled_layout(const Raster& layout, double distance);

// Area in which old points must be known for the new ones.
[[nodiscard]] Rectangle needed_for(const Raster& new_layout);

// Values at the points of the new layout. NaN if an old point that an interpolation needs has no data, or if half of
// those in a mean have none.
[[nodiscard]] Raster resampled(const Raster& raster, const Raster& new_layout);

}  // namespace thawslide::gis
