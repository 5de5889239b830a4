#include "base/raster_sampling.hpp"

#include <limits>

namespace thawslide {

double bilinear(const Raster& raster, double x, double y, Missing missing) {
  constexpr double rounding = 1e-9;  // in cells
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const double across = (x - raster.x) / raster.cell_x, up = (y - raster.y) / raster.cell_y;
  const double column = std::floor(across), row = std::floor(up);
  const double share_x = across - column, share_y = up - row;
  double value = 0.0, weight = 0.0;
  for (int k = 0; k < 4; ++k) {
    const int right = k % 2, above = k / 2;
    const double share = (right == 0 ? 1.0 - share_x : share_x) * (above == 0 ? 1.0 - share_y : share_y);
    if (share <= rounding) {
      continue;
    }
    const double i = column + right, j = row + above;
    const bool inside = i >= 0.0 && j >= 0.0 && i < raster.columns && j < raster.rows;
    const double there = inside ? raster.at(static_cast<int>(i), static_cast<int>(j)) : unknown;
    if (!std::isnan(there)) {
      value += share * there;
      weight += share;
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
