// The regular grid that maps are gathered on, and which of its cells a box overlaps.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "config/case.hpp"
#include "config/site.hpp"

namespace thawslide::sim {

// Cells are centred on points, as those of a raster are.
struct MapGrid {
  double x = 0.0, y = 0.0;            // of the first point, in the south-west [m]
  double cell_x = 1.0, cell_y = 1.0;  // [m]
  int columns = 0, rows = 0;
  std::string crs;  // as Raster::crs

  [[nodiscard]] double cell_area() const { return cell_x * cell_y; }  // [m2]
  // Cell borders count from the grid's lower left corner, in cells: cell k reaches from k to k + 1.
  [[nodiscard]] double column_of(double place) const { return (place - x) / cell_x + 0.5; }
  [[nodiscard]] double row_of(double place) const { return (place - y) / cell_y + 0.5; }
  [[nodiscard]] bool contains(double east, double north) const {
    const double column = column_of(east), row = row_of(north);
    return column >= 0.0 && column <= columns && row >= 0.0 && row <= rows;
  }
  // The cell that holds a place given in cells; on the grid's last border the one before it.
  [[nodiscard]] int cell_column(double column) const { return std::min(static_cast<int>(column), columns - 1); }
  [[nodiscard]] int cell_row(double row) const { return std::min(static_cast<int>(row), rows - 1); }
};

// So that a map that is written, a real for each cell, takes 2 GB of memory at most.
constexpr double most_map_cells = 2.5e8;

// The grid of the case's maps. Cells of maps.cell, or else of as many of the ground raster's as it takes for none to be
// narrower than the background grid's and three particle distances, begin at that raster's corner. Without a raster
// cells begin at the corner of the domain, of maps.cell or of the size of the background grid's. Whole cells are added
// on each side until the grid covers the domain, so that no part of a slide lies beside it. Throws UserError for more
// than most_map_cells.
[[nodiscard]] MapGrid map_grid_of(const config::Case& parameters, const config::Site& site);

// Why the cells of these maps are as large as they are, in words that follow on their size.
[[nodiscard]] std::string reason_for_map_cell(const config::Case& parameters, const config::Site& site);

// What to know of a maps.cell that is given and narrower than the background grid's; empty where there is nothing.
[[nodiscard]] std::string warning_of_map_cell(const config::Case& parameters, const config::Site& site);

}  // namespace thawslide::sim
