// Values at new points as weighted sums of old ones, along one axis and then along the other.
#pragma once

#include <vector>

#include "base/raster.hpp"

namespace thawslide::gis {

// The old points that make a new one along an axis.
struct AxisWeights {
  int first = 0;
  std::vector<double> weights;  // of old points first, first + 1, ...
};

// Per point of a layout: the sum of weights times values, and the sum of the weights, of old points with data.
struct WeightedSums {
  Raster values, weights;
};
[[nodiscard]] WeightedSums weighted_sums(const Raster& raster, const std::vector<AxisWeights>& along_x,
                                         const std::vector<AxisWeights>& along_y, const Raster& layout);

// Value over weight where the weight exceeds `least`; else NaN.
[[nodiscard]] Raster means_of(WeightedSums sums, double least);

}  // namespace thawslide::gis
