#include "gis/taper.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"

namespace thawslide::gis {

namespace {

std::vector<double> weights_of(double width, double cell) {
  const int reach = taper_reach(width, cell);
  std::vector<double> weights;
  double sum = 0.0;
  for (int k = -reach; k <= reach; ++k) {
    weights.push_back(1.0 + std::cos(2.0 * std::numbers::pi * k * cell / width));
    sum += weights.back();
  }
  for (double& weight : weights) {
    weight /= sum;
  }
  return weights;
}

// Distributes the value of each point to its neighbours along one axis.
Raster spread(const Raster& raster, const std::vector<double>& weights, int along_columns, int along_rows) {
  const int reach = static_cast<int>(weights.size() / 2);
  Raster result = raster.filled(0.0);
  for (int row = 0; row < raster.rows; ++row) {
    for (int column = 0; column < raster.columns; ++column) {
      const double value = raster.at(column, row);
      for (int k = -reach; value != 0.0 && k <= reach; ++k) {
        const int i = column + k * along_columns, j = row + k * along_rows;
        THAWSLIDE_ASSERT(i >= 0 && j >= 0 && i < raster.columns && j < raster.rows,
                         "the taper leaves the raster at column {}, row {}", i, j);
        result.values[result.index(i, j)] += value * weights[static_cast<std::size_t>(k + reach)];
      }
    }
  }
  return result;
}

}  // namespace

int taper_reach(double width, double cell) {
  return std::max(0, static_cast<int>(std::ceil(0.5 * width / cell - 1e-9)) - 1);
}

Raster tapered(const Raster& thickness, double width) {
  if (width <= 0.0) {
    return thickness;
  }
  return spread(spread(thickness, weights_of(width, thickness.cell_x), 1, 0), weights_of(width, thickness.cell_y), 0,
                1);
}

}  // namespace thawslide::gis
