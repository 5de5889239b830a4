// Regular grid of the maps, and the cells that overlap a box.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "config/case.hpp"
#include "config/site.hpp"

namespace thawslide::sim {

template <int Dim>
struct Model;

// Cells are centred on points, as in a raster.
struct MapGrid {
  double x = 0.0, y = 0.0;            // first point, in the south-west [m]
  double cell_x = 1.0, cell_y = 1.0;  // [m]
  int columns = 0, rows = 0;
  std::string crs;  // as Raster::crs

  [[nodiscard]] double cell_area() const { return cell_x * cell_y; }  // [m2]
  // Cell borders are counted from the grid's lower left corner, in cells: cell k extends from k to k + 1.
  [[nodiscard]] double column_of(double point) const { return (point - x) / cell_x + 0.5; }
  [[nodiscard]] double row_of(double point) const { return (point - y) / cell_y + 0.5; }
  [[nodiscard]] bool contains(double east, double north) const {
    const double column = column_of(east), row = row_of(north);
    return column >= 0.0 && column <= columns && row >= 0.0 && row <= rows;
  }
  // Cell that contains a coordinate in cells; on the grid's last border, the last cell.
  [[nodiscard]] int cell_column(double column) const { return std::min(static_cast<int>(column), columns - 1); }
  [[nodiscard]] int cell_row(double row) const { return std::min(static_cast<int>(row), rows - 1); }
};

// Limits the memory of a written map, one real per cell, to 2 GB.
constexpr double most_map_cells = 2.5e8;

// Map grid of the case. With a ground raster, cells begin at its corner. Their size is maps.cell or, by default, a
// multiple of the raster's cell that is at least the background cell and three particle spacings. Without a raster,
// cells begin at the corner of the domain, with maps.cell or the background cell. Whole cells are added on each side
// until the grid covers the domain, so no part of a slide lies outside it. Throws UserError for more than
// most_map_cells.
[[nodiscard]] MapGrid map_grid_of(const config::Case& parameters, const config::Site& site);

// Ground of cells that follow the terrain, at the centres of map cells [m]. NaN: outside the domain, or no data.
[[nodiscard]] Raster ground_of_cells(const config::Case& parameters, const config::Site& site, const Model<3>& model);

// Reason for the cell size, worded to follow the size in a sentence.
[[nodiscard]] std::string reason_for_map_cell(const config::Case& parameters, const config::Site& site);

// Warning if a given maps.cell is narrower than the background cell; empty otherwise.
[[nodiscard]] std::string warning_of_map_cell(const config::Case& parameters, const config::Site& site);

}  // namespace thawslide::sim
