// How much ground a slide covers, from the thickness of map cells.
//
// A cell that the slide has reached since the start is covered by a share that follows from its thickness h, as a cell
// at the edge is covered in part and then holds the thickness of the slide times the covered share:
//   share = h/max(h, h_in),  h_in = max over the eight directions of min(h_1, 2 h_1 - h_2)
// h_1, h_2: thickness of the next two cells in a direction; h_in: thickness of the slide over the cell as it follows
// from the cells farther inside, constant or falling evenly. Where a slide thins out evenly the share is 1. Cells
// without an uncovered neighbour are covered as a whole. The slide has reached a cell since the start where it is
// thicker than at the start by more than a tenth and, where it is covered, by `least`.
//
// Elsewhere a cell is covered as at the start, where that is drawn by the outlines of the releases and the sides of
// boxes. The DEM's points make ramps of the outlines, a cell wide, which are not counted. The ring by which a
// taper spreads a release beyond its outline is, where it is thicker than the least.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/raster.hpp"
#include "config/site.hpp"
#include "sim/map_grid.hpp"

namespace thawslide::sim {

// The covered ones of the 4 x 4 parts of a map cell, a bit each, row by row from the south-west.
using CellParts = std::uint16_t;
inline constexpr int parts_along = 4;  // of a cell, along each axis
inline constexpr int parts_of_cell = parts_along * parts_along;

// The parts of map cells whose middles lie in a body at the start: within the outlines of a release's polygons, or in
// the cells about the points of its raster that have a thickness, or, if it has a taper, where it is thicker than
// maps.arrival_thickness; and within boxes.
class DrawnArea {
 public:
  DrawnArea() = default;
  DrawnArea(const config::Case& parameters, const std::map<std::string, config::Release>& releases,
            const MapGrid& grid);

  // Whether there are releases at all: boxes alone make no ramps.
  [[nodiscard]] bool is_known() const { return is_known_; }
  [[nodiscard]] CellParts parts(int column, int row) const;

 private:
  void add_rings(const std::vector<config::Polyline2>& rings, const MapGrid& grid);
  template <class IsCovered>
  void add(const MapGrid& grid, const IsCovered& is_covered);

  bool is_known_ = false;
  int first_column_ = 0, first_row_ = 0, columns_ = 0, rows_ = 0;  // the cells about all releases
  std::vector<CellParts> parts_;                                   // of these, row by row
};

// Covered parts of all cells of a raster.
struct CoveredCells {
  Raster layout;  // without values
  std::vector<CellParts> parts;

  [[nodiscard]] double area() const;  // [m2], horizontal
  // 1 where the ground is covered and 0 elsewhere, on parts of cells; on whole cells, if there are too many to hold.
  [[nodiscard]] Raster mask() const;
};

// What is thicker than `least` [m] covers. thickness, start: [m] on the same cells, now or at most, and at t = 0; NaN:
// none. drawn: of a map grid in which these cells begin at the given column and row.
[[nodiscard]] CoveredCells covered_cells(const Raster& thickness, const Raster& start, const DrawnArea& drawn,
                                         int first_column, int first_row, double least);

// The share of a cell by its thickness.
[[nodiscard]] double covered_share(const Raster& thickness, int column, int row, double least);

}  // namespace thawslide::sim
