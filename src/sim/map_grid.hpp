// The regular grid that maps are gathered on, and which of its cells a box overlaps.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "base/portability.hpp"
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
    return column >= 0.0 && column < columns && row >= 0.0 && row < rows;
  }
};

// The grid of the case's maps: on the points of the ground's raster, or on cells of maps.cell that begin at that
// raster's corner; without a raster, on cells that begin at the corner of the domain, of maps.cell or of the size of
// the background grid's. Whole cells are added on each side until the grid covers the domain, so that no part of a
// slide lies beside it. Throws UserError for more cells than a raster can hold.
[[nodiscard]] MapGrid map_grid_of(const config::Case& parameters, const config::Site& site);

// The cells along one axis that a box overlaps, and its share in each; the shares sum to 1.
struct CellSpan {
  int first, last;
  double first_share, inner_share, last_share;

  [[nodiscard]] double share(int cell) const {
    return cell == first ? first_share : cell == last ? last_share : inner_share;
  }
};

// Of a box from middle - half to middle + half, in cells, on an axis of `cells` cells. A box that ends on a border, but
// for round-off, does not reach into the next cell. What lies beyond the grid counts to its last cell. inverse_width:
// 1/(2 half).
[[nodiscard]] inline CellSpan cell_span(double middle, double half, double inverse_width, int cells) {
  const double begin = middle - half, end = middle + half, sliver = round_off<double> * half;
  CellSpan span;
  span.first = std::clamp(static_cast<int>(std::floor(begin + sliver)), 0, cells - 1);
  span.last = std::clamp(static_cast<int>(std::floor(end - sliver)), 0, cells - 1);
  span.inner_share = inverse_width;
  span.last_share = (end - span.last) * inverse_width;
  span.first_share = span.first == span.last ? 1.0 : (span.first + 1 - begin) * inverse_width;
  return span;
}

}  // namespace thawslide::sim
