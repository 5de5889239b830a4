// Values at new points as separable weighted sums of old ones, along one axis and then the other.
#pragma once

#include <vector>

#include "base/raster.hpp"

namespace thawslide::gis {

// Weights of the old points for a new one along an axis.
struct AxisWeights {
  int first = 0;
  std::vector<double> weights;  // of old points first, first + 1, ...
};

// Sums at each point of a layout, over old points with data: of weights times values, and of weights.
struct WeightedSums {
  Raster values, weights;
};
[[nodiscard]] WeightedSums weighted_sums(const Raster& raster, const std::vector<AxisWeights>& along_x,
                                         const std::vector<AxisWeights>& along_y, const Raster& layout);

// Value over weight if the weight exceeds `least`; otherwise NaN.
[[nodiscard]] Raster means_of(WeightedSums sums, double least);

}  // namespace thawslide::gis
