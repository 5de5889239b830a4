// How much of each point's cell polygons cover, without an error but rounding.
//
// The cell of a point is the rectangle of cell_x by cell_y about it. The polygons are cut at the cells' edges, by
// halves: a piece that is cut at a line loses the corners beyond it and gains those where its edges meet the line
// (Sutherland and Hodgman 1974, Communications of the ACM 17, 32-42). The area of what is left in a cell, by Gauss's
// trapezoid formula, over the cell's area is the share.
#pragma once

#include "base/raster.hpp"
#include "gis/polygons.hpp"

namespace thawslide::gis {

// Shares from 0 to 1 at the points of the layout. The polygons may not overlap (union_of) and must lie within the cells
// of the points.
[[nodiscard]] Raster coverage_of(const Polygons& polygons, const Raster& layout);

}  // namespace thawslide::gis
