// Covered area of the slide, computed from the thickness of map cells.
//
// A cell that the slide has reached since the start is covered in part if it lies at the edge. Its thickness h is then
// the slide's thickness times the covered fraction:
//    share = h/max(h, h_in),  h_in = max over the eight directions of min(h_1, 2 h_1 - h_2)
// h_1, h_2: thickness of the next two cells in a direction; h_in: thickness of the slide over the cell, extrapolated
// from the cells farther inside as constant or linearly decreasing. If the slide thins out linearly, the fraction is 1.
// Cells without an uncovered neighbour are fully covered. The slide has reached a cell since the start if the cell is
// thicker than at the start by more than a tenth and, if it is covered, by `least`.
//
// Other cells are covered as at the start, by the outlines of the releases and the sides of boxes. The DEM's points
// turn outlines into ramps one cell wide, which are not counted. The margin by which a taper spreads a release beyond
// its outline counts where it is thicker than `least`.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/raster.hpp"
#include "config/site.hpp"
#include "sim/maps/map_grid.hpp"

namespace thawslide::sim {

// Covered parts of a map cell as a bit mask of 4 x 4 parts, row by row from the south-west.
using CellParts = std::uint16_t;
inline constexpr int parts_along = 4;  // per cell, along each axis
inline constexpr int parts_of_cell = parts_along * parts_along;

// Parts of map cells whose centres lie in a body at the start. A release covers the interior of its polygons, or the
// cells around raster points with a thickness, or, with a taper, the area thicker than maps.arrival_thickness. Boxes
// cover their interior.
class DrawnArea {
 public:
  DrawnArea() = default;
  DrawnArea(const config::Case& parameters, const std::map<std::string, config::Release>& releases,
            const MapGrid& grid);

  // True if there are releases; boxes alone form no ramps.
  [[nodiscard]] bool is_known() const { return is_known_; }
  [[nodiscard]] CellParts parts(int column, int row) const;

 private:
  void add_rings(const std::vector<config::Polyline2>& rings, const MapGrid& grid);
  template <class IsCovered>
  void add(const MapGrid& grid, const IsCovered& is_covered);

  bool is_known_ = false;
  int first_column_ = 0, first_row_ = 0, columns_ = 0, rows_ = 0;  // bounding cells of all releases
  std::vector<CellParts> parts_;                                   // of these cells, row by row
};

// Covered parts of all cells of a raster.
struct CoveredCells {
  Raster layout;  // without values
  std::vector<CellParts> parts;

  [[nodiscard]] double area() const;  // horizontal [m2]
  // Raster of 1 for covered ground and 0 elsewhere, on parts of cells, or on whole cells if there are too many parts.
  [[nodiscard]] Raster mask() const;
};

// Cells thicker than `least` [m] are covered. thickness, start: [m] on the same cells, current or maximum, and at t =
// 0; NaN: none. drawn: of a map grid in which these cells begin at the given column and row.
[[nodiscard]] CoveredCells covered_cells(const Raster& thickness, const Raster& start, const DrawnArea& drawn,
                                         int first_column, int first_row, double least);

// Covered fraction of a cell, from its thickness.
[[nodiscard]] double covered_fraction(const Raster& thickness, int column, int row, double least);

}  // namespace thawslide::sim
