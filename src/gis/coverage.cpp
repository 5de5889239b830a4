#include "gis/coverage.hpp"

#include "base/error.hpp"

namespace thawslide::gis {

namespace {

using Ring = std::vector<std::array<double, 2>>;  // in units of cells, from the corner of the first; not closed

// Part of a ring on one side of a line across an axis: side = 1 beyond it, -1 before it.
Ring cut(const Ring& ring, std::size_t axis, double line, double side) {
  Ring left;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const auto& corner = ring[k];
    const auto& next = ring[(k + 1) % ring.size()];
    const double here = side * (corner[axis] - line);
    const double there = side * (next[axis] - line);
    if (here >= 0.0) {
      left.push_back(corner);
    }
    if ((here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0)) {
      const double t = here / (here - there);
      std::array<double, 2> crossing{};
      crossing[axis] = line;
      crossing[1 - axis] = corner[1 - axis] + t * (next[1 - axis] - corner[1 - axis]);
      left.push_back(crossing);
    }
  }
  return left;
}

double area_in_cell(const Ring& ring, int column, int row) {
  double twice = 0.0;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const auto& corner = ring[k];
    const auto& next = ring[(k + 1) % ring.size()];
    twice += (corner[0] - column) * (next[1] - row) - (next[0] - column) * (corner[1] - row);
  }
  return 0.5 * twice;
}

// Adds the area of a ring in each cell of the columns and rows from `first` up to but excluding `last`, which contain
// all of it.
void add_area(const Ring& ring, double sign, std::array<int, 2> first, std::array<int, 2> last, Raster& fractions) {
  if (ring.size() < 3) {
    return;
  }
  const std::array<int, 2> count{last[0] - first[0], last[1] - first[1]};
  if (count[0] == 1 && count[1] == 1) {
    fractions.values[fractions.index(first[0], first[1])] += sign * area_in_cell(ring, first[0], first[1]);
    return;
  }
  const std::size_t axis = count[0] >= count[1] ? 0 : 1;
  const int middle = first[axis] + count[axis] / 2;
  std::array<int, 2> before_last = last, beyond_first = first;
  before_last[axis] = middle;
  beyond_first[axis] = middle;
  add_area(cut(ring, axis, middle, -1.0), sign, first, before_last, fractions);
  add_area(cut(ring, axis, middle, 1.0), sign, beyond_first, last, fractions);
}

void add_ring(const Polyline2& corners, bool is_hole, Raster& fractions) {
  Ring ring;
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
    ring.push_back({(corners[k][0] - fractions.x) / fractions.cell_x + 0.5,
                    (corners[k][1] - fractions.y) / fractions.cell_y + 0.5});
    THAWSLIDE_ASSERT(ring.back()[0] >= 0.0 && ring.back()[0] <= fractions.columns && ring.back()[1] >= 0.0 &&
                         ring.back()[1] <= fractions.rows,
                     "a corner at {}, {}, beyond the raster", corners[k][0], corners[k][1]);
  }
  const double orientation = signed_area(corners) > 0.0 ? 1.0 : -1.0;
  add_area(ring, is_hole ? -orientation : orientation, {0, 0}, {fractions.columns, fractions.rows}, fractions);
}

}  // namespace

Raster coverage_of(const Polygons& polygons, const Raster& layout) {
  Raster fractions = layout;
  fractions.values.assign(static_cast<std::size_t>(layout.columns) * static_cast<std::size_t>(layout.rows), 0.0);
  for (const Polygon& polygon : polygons) {
    add_ring(polygon.outline, false, fractions);
    for (const Polyline2& hole : polygon.holes) {
      add_ring(hole, true, fractions);
    }
  }
  constexpr double rounding = 1e-12;  // fraction of a cell: smaller differences from 0 and 1 are round-off
  for (double& fraction : fractions.values) {
    THAWSLIDE_ASSERT(fraction > -1e-9 && fraction < 1.0 + 1e-9, "a fraction of {}", fraction);
    fraction = fraction < rounding ? 0.0 : fraction > 1.0 - rounding ? 1.0 : fraction;
  }
  return fractions;
}

}  // namespace thawslide::gis
