#include "gis/point_window.hpp"

#include <cmath>

namespace thawslide::gis {

PointWindow points_in(const Raster& layout, const Rectangle& rectangle) {
  const auto range = [](double low, double high, double first, double cell, int count, int& begin, int& number) {
    const double most = count - 1;
    const double from = std::floor((low - first) / cell);
    const double to = std::ceil((high - first) / cell);
    if (!(from <= most && to >= 0.0 && low <= high)) {
      number = 0;
      return;
    }
    begin = static_cast<int>(std::max(from, 0.0));
    number = static_cast<int>(std::min(to, most)) - begin + 1;
  };
  PointWindow window;
  range(rectangle.min_x, rectangle.max_x, layout.x, layout.cell_x, layout.columns, window.first_column, window.columns);
  range(rectangle.min_y, rectangle.max_y, layout.y, layout.cell_y, layout.rows, window.first_row, window.rows);
  return window;
}

PointWindow points_of(const Raster& part, const Raster& layout) {
  const auto range = [](double coordinate, int part_count, int count, int& begin, int& number) {
    const auto first = static_cast<int>(std::lround(coordinate));
    begin = std::max(first, 0);
    number = std::max(std::min(first + part_count, count) - begin, 0);
  };
  PointWindow window;
  range((part.x - layout.x) / layout.cell_x, part.columns, layout.columns, window.first_column, window.columns);
  range((part.y - layout.y) / layout.cell_y, part.rows, layout.rows, window.first_row, window.rows);
  return window;
}

Raster layout_of(const Raster& layout, const PointWindow& window) {
  Raster part;
  part.x = layout.x_of(window.first_column);
  part.y = layout.y_of(window.first_row);
  part.cell_x = layout.cell_x;
  part.cell_y = layout.cell_y;
  part.columns = window.columns;
  part.rows = window.rows;
  part.crs = layout.crs;
  return part;
}

Raster part_of(const Raster& raster, const PointWindow& window) {
  Raster part = layout_of(raster, window);
  for (int row = 0; row < part.rows; ++row) {
    const auto first =
        raster.values.begin() + static_cast<std::ptrdiff_t>(raster.index(window.first_column, window.first_row + row));
    part.values.insert(part.values.end(), first, first + part.columns);
  }
  return part;
}

Rectangle span_of_points(const Raster& layout) { return {layout.x, layout.y, layout.x_end(), layout.y_end()}; }

}  // namespace thawslide::gis
