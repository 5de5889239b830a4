#include "gis/resampling.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "gis/axis_weights.hpp"

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

struct Axis {
  double first, cell;
  int count;
};

bool is_mean(double old_cell, double new_cell) { return new_cell > old_cell * (1.0 + 1e-9); }

std::vector<AxisWeights> weights_of(const Axis& old_axis, const Axis& new_axis) {
  std::vector<AxisWeights> all;
  for (int k = 0; k < new_axis.count; ++k) {
    const double coordinate = (new_axis.first + k * new_axis.cell - old_axis.first) / old_axis.cell;
    const bool averaged = is_mean(old_axis.cell, new_axis.cell);
    all.push_back(averaged ? mean(coordinate, new_axis.cell / old_axis.cell, old_axis.count)
                           : interpolation(coordinate, old_axis.count));
    const AxisWeights& made = all.back();
    THAWSLIDE_ASSERT(made.first + static_cast<int>(made.weights.size()) <= old_axis.count,
                     "point {} needs old points from {} of {}", k, made.first, old_axis.count);
  }
  return all;
}

}  // namespace

Raster resampled_layout(const Raster& layout, double distance) {
  const auto along = [&](double first, double cell, int count, double& new_first, int& new_count) {
    const double margin = is_mean(cell, distance) ? 0.5 * distance : 0.0;
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

Raster resampled(const Raster& raster, const Raster& new_layout) {
  const auto along_x =
      weights_of({raster.x, raster.cell_x, raster.columns}, {new_layout.x, new_layout.cell_x, new_layout.columns});
  const auto along_y =
      weights_of({raster.y, raster.cell_y, raster.rows}, {new_layout.y, new_layout.cell_y, new_layout.rows});
  const bool is_averaged = is_mean(raster.cell_x, new_layout.cell_x) || is_mean(raster.cell_y, new_layout.cell_y);
  return means_of(weighted_sums(raster, along_x, along_y, new_layout), is_averaged ? 0.5 : 1.0 - 1e-9);
}

}  // namespace thawslide::gis
