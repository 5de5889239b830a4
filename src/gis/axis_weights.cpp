#include "gis/axis_weights.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "base/parallel.hpp"

namespace thawslide::gis {

WeightedSums weighted_sums(const Raster& raster, const std::vector<AxisWeights>& along_x,
                           const std::vector<AxisWeights>& along_y, const Raster& layout) {
  const std::size_t columns = along_x.size();
  std::vector<double> row_values(columns * static_cast<std::size_t>(raster.rows));
  std::vector<double> row_weights = row_values;
  parallel_for(static_cast<std::size_t>(raster.rows), [&](std::size_t row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const AxisWeights& made = along_x[column];
      const double* old = raster.values.data() + raster.index(made.first, static_cast<int>(row));
      double value = 0.0, weight = 0.0;
      for (std::size_t k = 0; k < made.weights.size(); ++k) {
        if (!std::isnan(old[k])) {
          value += made.weights[k] * old[k];
          weight += made.weights[k];
        }
      }
      row_values[row * columns + column] = value;
      row_weights[row * columns + column] = weight;
    }
  });
  WeightedSums sums{layout, layout};
  sums.values.values.resize(columns * along_y.size());
  sums.weights.values = sums.values.values;
  parallel_for(along_y.size(), [&](std::size_t row) {
    const AxisWeights& made = along_y[row];
    for (std::size_t column = 0; column < columns; ++column) {
      double value = 0.0, weight = 0.0;
      for (std::size_t k = 0; k < made.weights.size(); ++k) {
        const std::size_t from = (static_cast<std::size_t>(made.first) + k) * columns + column;
        value += made.weights[k] * row_values[from];
        weight += made.weights[k] * row_weights[from];
      }
      sums.values.values[row * columns + column] = value;
      sums.weights.values[row * columns + column] = weight;
    }
  });
  return sums;
}

Raster means_of(WeightedSums sums, double least) {
  Raster& result = sums.values;
  for (std::size_t k = 0; k < result.values.size(); ++k) {
    const double weight = sums.weights.values[k];
    result.values[k] = weight > least ? result.values[k] / weight : std::numeric_limits<double>::quiet_NaN();
  }
  return std::move(result);
}

}  // namespace thawslide::gis
