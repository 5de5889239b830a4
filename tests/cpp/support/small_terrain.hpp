// Small DEMs.
#pragma once

#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "base/linear.hpp"
#include "base/raster.hpp"

namespace thawslide::testing_support {

using Place = Vector<double, 2>;
using Position = Vector<double, 3>;
constexpr double no_data = std::numeric_limits<double>::quiet_NaN();

inline Raster raster(double x, double y, double cell, int columns, int rows,
                     const std::function<double(double, double)>& height) {
  Raster made{
      .x = x, .y = y, .cell_x = cell, .cell_y = cell, .columns = columns, .rows = rows, .values = {}, .crs = {}};
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      made.values.push_back(height(made.x_of(column), made.y_of(row)));
    }
  }
  return made;
}

inline Raster rough_raster() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> height(0.0, 12.0);
  return raster(-20.0, -15.0, 5.0, 21, 17, [&](double, double) { return height(random); });
}

}  // namespace thawslide::testing_support
