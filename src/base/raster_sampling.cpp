#include "base/raster_sampling.hpp"

#include <limits>

namespace thawslide {

double bilinear(const Raster& raster, double x, double y, Missing missing) {
  constexpr double rounding = 1e-9;  // in cells
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const double across = (x - raster.x) / raster.cell_x, up = (y - raster.y) / raster.cell_y;
  const double column = std::floor(across), row = std::floor(up);
  const double fraction_x = across - column, fraction_y = up - row;
  double value = 0.0, weight = 0.0;
  for (int k = 0; k < 4; ++k) {
    const int right = k % 2, above = k / 2;
    const double fraction = (right == 0 ? 1.0 - fraction_x : fraction_x) * (above == 0 ? 1.0 - fraction_y : fraction_y);
    if (fraction <= rounding) {
      continue;
    }
    const double i = column + right, j = row + above;
    const bool inside = i >= 0.0 && j >= 0.0 && i < raster.columns && j < raster.rows;
    const double there = inside ? raster.at(static_cast<int>(i), static_cast<int>(j)) : unknown;
    if (!std::isnan(there)) {
      value += fraction * there;
      weight += fraction;
    } else if (missing == Missing::unknown || (missing == Missing::nothing && !inside)) {
      return unknown;
    }
  }
  return missing == Missing::zero ? value : weight > 0.0 ? value / weight : unknown;
}

double volume_of(const Raster& thickness) {
  double sum = 0.0;
  for (const double value : thickness.values) {
    sum += std::isnan(value) ? 0.0 : value;
  }
  return sum * thickness.cell_x * thickness.cell_y;
}

}  // namespace thawslide
