#include "gis/sampling.hpp"

#include <cmath>

#include "base/error.hpp"
#include "base/rounding.hpp"
#include "gis/averaging.hpp"
#include "gis/reference_system.hpp"
#include "gis/reprojection.hpp"

namespace thawslide::gis {

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
  if (is_finer(raster, layout)) {
    return averaged(raster, layout, missing);
  }
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
          "points of the ground near {}, {} cannot be transformed to the coordinate reference system {}. Reproject the "
          "raster to {}.",
          coordinate_text(layout.x), coordinate_text(layout.y_of(row)), name_of(raster.crs), name_of(layout.crs));
    }
    for (int column = 0; column < layout.columns; ++column) {
      const auto k = static_cast<std::size_t>(column);
      result.values[result.index(column, row)] = bilinear(raster, x[k], y[k], missing);
    }
  }
  return result;
}

Raster above_ground(const Raster& surface, const Raster& ground) {
  Raster above = sampled(ground, surface, Missing::unknown);
  for (std::size_t k = 0; k < above.values.size(); ++k) {
    above.values[k] = surface.values[k] - above.values[k];
  }
  return above;
}

}  // namespace thawslide::gis
