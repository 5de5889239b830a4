// Windows of a grid of points.
#pragma once

#include "base/raster.hpp"
#include "gis/rectangle.hpp"

namespace thawslide::gis {

// Columns and rows of a grid of points: first index and number.
struct PointWindow {
  int first_column = 0, first_row = 0, columns = 0, rows = 0;
};

// Points of the layout in the rectangle, and one more on each side; none (0 columns or rows) if the rectangle lies
// outside.
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
