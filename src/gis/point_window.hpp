// Rectangles in the horizontal plane, and windows of a grid of points.
#pragma once

#include <algorithm>

#include "base/raster.hpp"

namespace thawslide::gis {

struct Rectangle {
  double min_x = 0.0, min_y = 0.0, max_x = 0.0, max_y = 0.0;  // [m], or degrees in a geographic reference system

  [[nodiscard]] bool contains(double x, double y) const { return x >= min_x && x <= max_x && y >= min_y && y <= max_y; }
  [[nodiscard]] bool contains(const Rectangle& other) const {
    return contains(other.min_x, other.min_y) && contains(other.max_x, other.max_y);
  }
  [[nodiscard]] bool touches(const Rectangle& other) const {
    return min_x <= other.max_x && other.min_x <= max_x && min_y <= other.max_y && other.min_y <= max_y;
  }
  [[nodiscard]] Rectangle widened(double along_x, double along_y) const {
    return {min_x - along_x, min_y - along_y, max_x + along_x, max_y + along_y};
  }
  void include(double x, double y) {
    min_x = std::min(min_x, x);
    max_x = std::max(max_x, x);
    min_y = std::min(min_y, y);
    max_y = std::max(max_y, y);
  }
};

// Columns and rows of a grid of points: first index and number.
struct PointWindow {
  int first_column = 0, first_row = 0, columns = 0, rows = 0;
};

// Points of the layout in the rectangle, and one more on each side; none (0 columns or rows) if it lies outside.
[[nodiscard]] PointWindow points_in(const Raster& layout, const Rectangle& rectangle);

// Points of `part` in the indices of `layout`, both windows of one grid; points outside `layout` are omitted.
[[nodiscard]] PointWindow points_of(const Raster& part, const Raster& layout);

// The same grid reduced to a window, without values.
[[nodiscard]] Raster layout_of(const Raster& layout, const PointWindow& window);

// The same with values.
[[nodiscard]] Raster part_of(const Raster& raster, const PointWindow& window);

// Rectangle from the first to the last point.
[[nodiscard]] Rectangle span_of_points(const Raster& layout);

}  // namespace thawslide::gis
