// Conversion between polygons and rasters.
#pragma once

#include "base/raster.hpp"
#include "gis/polygons.hpp"

namespace thawslide::gis {

// Fraction of each point's cell covered by polygons, exact to round-off: from 0 to 1 at the points of the layout.
//
// The cell of a point is the surrounding rectangle of cell_x by cell_y. The polygons are clipped at the cells' edges by
// bisection. Clipping at a line removes the corners beyond it and adds the intersections of the edges with the line
// (Sutherland and Hodgman 1974, Communications of the ACM 17, 32-42). The fraction is the remaining area in a cell, by
// Gauss's trapezoid formula, divided by the cell's area.
//
// The polygons must not overlap (union_of) and must lie within the cells of the points.
[[nodiscard]] Raster coverage_of(const Polygons& polygons, const Raster& layout);

// Areas with holes of the cells around points whose value is neither 0 nor NaN; cells that share an edge are joined.
[[nodiscard]] Polygons areas_of_mask(const Raster& mask);

}  // namespace thawslide::gis
