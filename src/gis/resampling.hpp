// Resampling of a raster at new points. Only the requested points are computed, from a sufficiently large part of the
// file, so cropping does not change a value.
//
// Along each axis, a value at the new points is a weighted sum of old ones. If the new spacing is at most the old one,
// values are interpolated linearly. Points with a larger spacing get the mean of the linear interpolation over an
// interval of the new spacing, centred on each. Both reproduce a plane exactly.
#pragma once

#include <functional>
#include <vector>

#include "base/raster.hpp"
#include "gis/rectangle.hpp"

namespace thawslide::gis {

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
