#include "gis/sampling.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "base/error.hpp"
#include "gis/reference_system.hpp"
#include "gis/reprojection.hpp"

namespace thawslide::gis {

namespace {

constexpr double no_data = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double bilinear(const Raster& raster, double x, double y, Missing missing) {
  const double beyond = missing == Missing::zero ? 0.0 : no_data;
  constexpr double rounding = 1e-9;  // cells
  const double place_x = (x - raster.x) / raster.cell_x, place_y = (y - raster.y) / raster.cell_y;
  if (!(place_x >= -rounding && place_x <= raster.columns - 1 + rounding && place_y >= -rounding &&
        place_y <= raster.rows - 1 + rounding)) {
    return beyond;
  }
  const int column = std::clamp(static_cast<int>(std::floor(place_x)), 0, std::max(raster.columns - 2, 0));
  const int row = std::clamp(static_cast<int>(std::floor(place_y)), 0, std::max(raster.rows - 2, 0));
  const double s = std::clamp(place_x - column, 0.0, 1.0), t = std::clamp(place_y - row, 0.0, 1.0);
  double value = 0.0, weight = 0.0;
  const auto add = [&](int i, int j, double share) {
    const double one = share > rounding ? raster.at(i, j) : no_data;
    if (!std::isnan(one)) {
      value += share * one;
      weight += share;
    }
  };
  add(column, row, (1.0 - s) * (1.0 - t));
  add(column + 1, row, s * (1.0 - t));
  add(column, row + 1, (1.0 - s) * t);
  add(column + 1, row + 1, s * t);
  return weight == 0.0 ? beyond : missing == Missing::zero ? value : value / weight;
}

Gradient gradient_at(const Raster& raster, int column, int row) {
  const double here = raster.at(column, row);
  const auto along = [&](int before_column, int before_row, int after_column, int after_row, double cell) {
    const auto known = [&](int i, int j) {
      return i >= 0 && j >= 0 && i < raster.columns && j < raster.rows && !std::isnan(raster.at(i, j));
    };
    const bool before = known(before_column, before_row), after = known(after_column, after_row);
    const double low = before ? raster.at(before_column, before_row) : here;
    const double high = after ? raster.at(after_column, after_row) : here;
    return before && after ? (high - low) / (2.0 * cell) : (high - low) / cell;
  };
  return {along(column - 1, row, column + 1, row, raster.cell_x),
          along(column, row - 1, column, row + 1, raster.cell_y)};
}

Raster sampled(const Raster& raster, const Raster& layout, Missing missing) {
  const Reprojection reprojection(layout.crs, raster.crs);
  Raster result = layout;
  result.values.resize(static_cast<std::size_t>(layout.columns) * static_cast<std::size_t>(layout.rows));
  const auto columns = static_cast<std::size_t>(layout.columns);
  std::vector<double> x(columns), y(columns);
  for (int row = 0; row < layout.rows; ++row) {
    for (int column = 0; column < layout.columns; ++column) {
      x[static_cast<std::size_t>(column)] = layout.x_of(column);
      y[static_cast<std::size_t>(column)] = layout.y_of(row);
    }
    if (!reprojection.apply(x, y)) {
      throw UserError(
          fmt::format("points of the ground near {:.10g}, {:.10g} have no place in the coordinate reference "
                      "system {}. Reproject the raster to {}.",
                      layout.x, layout.y_of(row), name_of(raster.crs), name_of(layout.crs)));
    }
    for (int column = 0; column < layout.columns; ++column) {
      const auto k = static_cast<std::size_t>(column);
      result.values[result.index(column, row)] = bilinear(raster, x[k], y[k], missing);
    }
  }
  return result;
}

void fill_from_nearest(Raster& raster) {
  std::deque<std::pair<int, int>> front;
  for (int row = 0; row < raster.rows; ++row) {
    for (int column = 0; column < raster.columns; ++column) {
      if (!std::isnan(raster.at(column, row))) {
        front.emplace_back(column, row);
      }
    }
  }
  while (!front.empty()) {
    const auto [column, row] = front.front();
    front.pop_front();
    for (const auto& [i, j] : {std::pair{column - 1, row}, std::pair{column + 1, row}, std::pair{column, row - 1},
                               std::pair{column, row + 1}}) {
      if (i >= 0 && j >= 0 && i < raster.columns && j < raster.rows && std::isnan(raster.at(i, j))) {
        raster.values[raster.index(i, j)] = raster.at(column, row);
        front.emplace_back(i, j);
      }
    }
  }
}

}  // namespace thawslide::gis
