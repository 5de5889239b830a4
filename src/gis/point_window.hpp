// Parts of a grid of points.
#pragma once

#include "base/raster.hpp"
#include "gis/rectangle.hpp"

namespace thawslide::gis {

// Columns and rows of a grid of points: from the first one, so many.
struct PointWindow {
  int first_column = 0, first_row = 0, columns = 0, rows = 0;
};

// The points of the layout that lie in the rectangle, and one more on each side; none (0 columns or rows) where the
// rectangle lies outside.
[[nodiscard]] PointWindow points_in(const Raster& layout, const Rectangle& rectangle);

// The points of `part` in the indices of `layout`, of which both are part; those that `layout` lacks are left out.
[[nodiscard]] PointWindow points_of(const Raster& part, const Raster& layout);

// The same grid reduced to a window, without values.
[[nodiscard]] Raster layout_of(const Raster& layout, const PointWindow& window);

// The same with the values there.
[[nodiscard]] Raster part_of(const Raster& raster, const PointWindow& window);

// From the first to the last point.
[[nodiscard]] Rectangle span_of_points(const Raster& layout);

}  // namespace thawslide::gis
