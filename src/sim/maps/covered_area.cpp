#include "sim/maps/covered_area.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

#include "base/raster.hpp"

namespace thawslide::sim {

namespace {

constexpr double most_parts = 1.6e7;  // of a mask: 128 MB
constexpr double noticed_rise = 0.1;  // of the initial thickness: settling changes it by less
constexpr std::array<std::array<int, 2>, 8> directions{
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

// Returns 0 outside the raster.
double thickness_at(const Raster& thickness, int column, int row) {
  if (column < 0 || row < 0 || column >= thickness.columns || row >= thickness.rows) {
    return 0.0;
  }
  const double h = thickness.at(column, row);
  return h > 0.0 ? h : 0.0;
}

// Selects `count` parts of a cell, beginning at the side on which the slide is thicker.
CellParts inner_parts(const Raster& thickness, int column, int row, long count) {
  if (count <= 0 || count >= parts_of_cell) {
    return count <= 0 ? CellParts{0} : static_cast<CellParts>(~CellParts{0});
  }
  double inwards_x = 0.0, inwards_y = 0.0;
  for (const auto& [x, y] : directions) {
    const double h = thickness_at(thickness, column + x, row + y) / std::hypot(x, y);
    inwards_x += x * h;
    inwards_y += y * h;
  }
  std::array<int, parts_of_cell> order{};
  for (int k = 0; k < parts_of_cell; ++k) {
    order[static_cast<std::size_t>(k)] = k;
  }
  const auto depth = [&](int part) {
    const int along_x = part % parts_along, along_y = part / parts_along;
    return inwards_x * along_x + inwards_y * along_y;
  };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return depth(a) > depth(b); });
  unsigned parts = 0;
  for (long k = 0; k < count; ++k) {
    parts |= 1U << order[static_cast<std::size_t>(k)];
  }
  return static_cast<CellParts>(parts);
}

CellParts parts_for_fraction(const Raster& thickness, int column, int row, double fraction) {
  return inner_parts(thickness, column, row, std::lround(fraction * parts_of_cell));
}

// Intersections of the rings with the horizontal line at y, from west to east.
std::vector<double> crossings(const std::vector<config::Polyline2>& rings, double y) {
  std::vector<double> crossings;
  for (const config::Polyline2& ring : rings) {
    for (std::size_t k = 0; k + 1 < ring.size(); ++k) {
      const auto& [x0, y0] = ring[k];
      const auto& [x1, y1] = ring[k + 1];
      if ((y0 <= y) != (y1 <= y)) {
        crossings.push_back(x0 + (y - y0) / (y1 - y0) * (x1 - x0));
      }
    }
  }
  std::sort(crossings.begin(), crossings.end());
  return crossings;
}

using Ends = std::array<double, 4>;  // west, south, east and north extremes [m]

Ends ends_of(const config::Release& release) {
  const Raster& t = release.thickness;
  return {t.x - t.cell_x, t.y - t.cell_y, t.x_end() + t.cell_x, t.y_end() + t.cell_y};
}

Ends ends_of(const config::Body& box) { return {box.min[0], box.min[1], box.max[0], box.max[1]}; }

bool has_thickness(const Raster& raster, double x, double y) {
  return thickness_at(raster, static_cast<int>(std::lround((x - raster.x) / raster.cell_x)),
                      static_cast<int>(std::lround((y - raster.y) / raster.cell_y))) > 0.0;
}

// A taper narrower than two cells of the ground reaches none of its points.
bool spreads_by_taper(const config::Body& body, const Raster& thickness) {
  return body.taper > 2.0 * std::min(thickness.cell_x, thickness.cell_y);
}

}  // namespace

DrawnArea::DrawnArea(const config::Case& parameters, const std::map<std::string, config::Release>& releases,
                     const MapGrid& grid)
    : is_known_(!releases.empty()) {
  if (!is_known_) {
    return;
  }
  Ends ends{HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (const auto& [name, body] : parameters.bodies) {
    const auto release = releases.find(name);
    const Ends of_body = release == releases.end() ? ends_of(body) : ends_of(release->second);
    ends = {std::min(ends[0], of_body[0]), std::min(ends[1], of_body[1]), std::max(ends[2], of_body[2]),
            std::max(ends[3], of_body[3])};
  }
  const auto cell = [](double point, int cells) {
    return std::clamp(static_cast<int>(std::floor(point)), 0, cells - 1);
  };
  first_column_ = cell(grid.column_of(ends[0]), grid.columns);
  first_row_ = cell(grid.row_of(ends[1]), grid.rows);
  columns_ = cell(grid.column_of(ends[2]), grid.columns) - first_column_ + 1;
  rows_ = cell(grid.row_of(ends[3]), grid.rows) - first_row_ + 1;
  parts_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0);
  for (const auto& [name, body] : parameters.bodies) {
    const auto found = releases.find(name);
    if (found == releases.end()) {
      const auto& [west, south, east, north] = ends_of(body);
      add_rings({{{west, south}, {east, south}, {east, north}, {west, north}, {west, south}}}, grid);
      continue;
    }
    const Raster& thickness = found->second.thickness;
    if (spreads_by_taper(body, thickness)) {
      const double least = parameters.maps.arrival_thickness;
      add(grid, [&](double x, double y) { return bilinear(thickness, x, y, Missing::zero) > least; });
    } else if (found->second.outlines.empty()) {
      add(grid, [&](double x, double y) { return has_thickness(thickness, x, y); });
    } else {
      add_rings(found->second.outlines, grid);
    }
  }
}

void DrawnArea::add_rings(const std::vector<config::Polyline2>& rings, const MapGrid& grid) {
  double crossed_at = std::nan("");
  std::vector<double> crossed;
  add(grid, [&](double x, double y) {
    if (y != crossed_at) {
      crossed = crossings(rings, y);
      crossed_at = y;
    }
    return (std::upper_bound(crossed.begin(), crossed.end(), x) - crossed.begin()) % 2 != 0;
  });
}

template <class IsCovered>
void DrawnArea::add(const MapGrid& grid, const IsCovered& is_covered) {
  for (int k = 0; k < rows_ * parts_along; ++k) {
    const int row = k / parts_along;
    const double y = grid.y + (first_row_ + (k + 0.5) / parts_along - 0.5) * grid.cell_y;
    for (int j = 0; j < columns_ * parts_along; ++j) {
      const double x = grid.x + (first_column_ + (j + 0.5) / parts_along - 0.5) * grid.cell_x;
      if (is_covered(x, y)) {
        const int part = k % parts_along * parts_along + j % parts_along;
        CellParts& parts = parts_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                                  static_cast<std::size_t>(j / parts_along)];
        parts = static_cast<CellParts>(parts | 1U << part);
      }
    }
  }
}

CellParts DrawnArea::parts(int column, int row) const {
  const int i = column - first_column_, j = row - first_row_;
  return i < 0 || j < 0 || i >= columns_ || j >= rows_
             ? CellParts{0}
             : parts_[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i)];
}

double covered_fraction(const Raster& thickness, int column, int row, double least) {
  const double h = thickness_at(thickness, column, row);
  bool is_edge = h <= least;
  double inside = 0.0;
  for (const auto& [x, y] : directions) {
    const double next = thickness_at(thickness, column + x, row + y);
    is_edge = is_edge || next <= least;
    inside = std::max(inside, std::min(next, 2.0 * next - thickness_at(thickness, column + 2 * x, row + 2 * y)));
  }
  if (!is_edge) {
    return 1.0;
  }
  const double of_slide = std::max(h, inside);
  return of_slide > least ? h / of_slide : 0.0;
}

CoveredCells covered_cells(const Raster& thickness, const Raster& start, const DrawnArea& drawn, int first_column,
                           int first_row, double least) {
  CoveredCells covered{thickness, {}};
  covered.layout.values.clear();
  covered.parts.reserve(thickness.values.size());
  for (int row = 0; row < thickness.rows; ++row) {
    for (int column = 0; column < thickness.columns; ++column) {
      const double h = thickness_at(thickness, column, row), before = thickness_at(start, column, row);
      const CellParts at_start =
          drawn.is_known() ? drawn.parts(first_column + column, first_row + row)
                           : parts_for_fraction(start, column, row, covered_fraction(start, column, row, least));
      const double fraction_at_start = std::popcount(at_start) / static_cast<double>(parts_of_cell);
      unsigned parts = h > fraction_at_start * least ? at_start : 0U;
      const double fraction = covered_fraction(thickness, column, row, least);
      if (h - before > std::max(fraction * least, noticed_rise * before)) {
        parts |= parts_for_fraction(thickness, column, row, fraction);
      }
      covered.parts.push_back(static_cast<CellParts>(parts));
    }
  }
  return covered;
}

double CoveredCells::area() const {
  double count = 0.0;
  for (const CellParts each : parts) {
    count += std::popcount(each);
  }
  return count / parts_of_cell * layout.cell_x * layout.cell_y;
}

Raster CoveredCells::mask() const {
  Raster mask = layout;
  const bool is_fine = static_cast<double>(parts.size()) * parts_of_cell <= most_parts;
  const int along = is_fine ? parts_along : 1;
  mask.cell_x = layout.cell_x / along;
  mask.cell_y = layout.cell_y / along;
  mask.columns = layout.columns * along;
  mask.rows = layout.rows * along;
  mask.x = layout.x - 0.5 * (layout.cell_x - mask.cell_x);
  mask.y = layout.y - 0.5 * (layout.cell_y - mask.cell_y);
  mask.values.reserve(static_cast<std::size_t>(mask.columns) * static_cast<std::size_t>(mask.rows));
  for (int row = 0; row < mask.rows; ++row) {
    for (int column = 0; column < mask.columns; ++column) {
      const CellParts cell = parts[layout.index(column / along, row / along)];
      const int part = row % along * parts_along + column % along;
      const bool is_covered = is_fine ? (cell >> part & 1U) != 0 : 2 * std::popcount(cell) >= parts_of_cell;
      mask.values.push_back(is_covered ? 1.0 : 0.0);
    }
  }
  return mask;
}

}  // namespace thawslide::sim
