#include "gis/resampling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/parallel.hpp"

namespace thawslide::gis {

namespace {

// Integral from minus infinity to t of the linear shape function, which is 1 at 0 and decreases to 0 at -1 and 1.
double linear_integral(double t) {
  const double s = std::clamp(t, -1.0, 1.0);
  return s < 0.0 ? 0.5 * (1.0 + s) * (1.0 + s) : 1.0 - 0.5 * (1.0 - s) * (1.0 - s);
}

// Weights along one axis: position in units of the old spacing, relative to the first old point.
AxisWeights interpolation(double coordinate, int count) {
  const int first = std::clamp(static_cast<int>(std::floor(coordinate)), 0, std::max(count - 2, 0));
  const double fraction = coordinate - first;
  // A new point on an old one needs no neighbour, which may have no data.
  constexpr double rounding = 1e-9;
  if (fraction < rounding || count == 1) {
    return {first, {1.0}};
  }
  if (fraction > 1.0 - rounding) {
    return {first + 1, {1.0}};
  }
  return {first, {1.0 - fraction, fraction}};
}

AxisWeights mean(double coordinate, double width, int count) {
  const double low = coordinate - 0.5 * width, high = coordinate + 0.5 * width;
  const int first = std::clamp(static_cast<int>(std::floor(low)), 0, count - 1);
  const int last = std::clamp(static_cast<int>(std::ceil(high)), 0, count - 1);
  AxisWeights result{first, {}};
  for (int k = first; k <= last; ++k) {
    result.weights.push_back((linear_integral(high - k) - linear_integral(low - k)) / width);
  }
  return result;
}

bool is_mean(double width) { return width > 1.0 + 1e-9; }

// Weights of the old points for each new one along an axis, which is given by its first point, spacing and number.
std::vector<AxisWeights> weights_along(double first, double cell, int count, double new_first, double new_cell,
                                       int new_count, const WeightsOfPoint& weights_of) {
  std::vector<AxisWeights> all;
  for (int k = 0; k < new_count; ++k) {
    all.push_back(weights_of((new_first + k * new_cell - first) / cell, new_cell / cell, count));
    THAWSLIDE_ASSERT(all.back().first + static_cast<int>(all.back().weights.size()) <= count,
                     "point {} needs old points from {} of {}", k, all.back().first, count);
  }
  return all;
}

}  // namespace

Raster resampled_layout(const Raster& layout, double distance) {
  const auto along = [&](double first, double cell, int count, double& new_first, int& new_count) {
    const double margin = is_mean(distance / cell) ? 0.5 * distance : 0.0;
    const double available = (count - 1) * cell - 2.0 * margin;
    new_first = first + margin;
    new_count = available < 0.0 ? 0 : static_cast<int>(std::floor(available / distance + 1e-9)) + 1;
  };
  Raster result;
  result.cell_x = result.cell_y = distance;
  result.crs = layout.crs;
  along(layout.x, layout.cell_x, layout.columns, result.x, result.columns);
  along(layout.y, layout.cell_y, layout.rows, result.y, result.rows);
  return result;
}

Rectangle needed_for(const Raster& new_layout) {
  return Rectangle{new_layout.x, new_layout.y, new_layout.x_end(), new_layout.y_end()}.widened(0.5 * new_layout.cell_x,
                                                                                               0.5 * new_layout.cell_y);
}

WeightedSums weighted_sums(const Raster& raster, const Raster& layout, const WeightsOfPoint& weights_of) {
  const std::vector<AxisWeights> along_x =
      weights_along(raster.x, raster.cell_x, raster.columns, layout.x, layout.cell_x, layout.columns, weights_of);
  const std::vector<AxisWeights> along_y =
      weights_along(raster.y, raster.cell_y, raster.rows, layout.y, layout.cell_y, layout.rows, weights_of);
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
  WeightedSums sums{layout.filled(0.0), layout.filled(0.0)};
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

Raster resampled(const Raster& raster, const Raster& new_layout) {
  const WeightedSums sums = weighted_sums(raster, new_layout, [](double coordinate, double width, int count) {
    return is_mean(width) ? mean(coordinate, width, count) : interpolation(coordinate, count);
  });
  const bool is_averaged = is_mean(new_layout.cell_x / raster.cell_x) || is_mean(new_layout.cell_y / raster.cell_y);
  return means_of(sums, is_averaged ? 0.5 : 1.0 - 1e-9);
}

}  // namespace thawslide::gis
