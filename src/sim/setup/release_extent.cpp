#include "sim/setup/release_extent.hpp"

#include <algorithm>
#include <cmath>

#include "base/raster_sampling.hpp"

namespace thawslide::sim {

namespace {

// Adds the corners of the cell around a raster point.
void add_cell(const Raster& raster, int column, int row, config::Polyline2& corners) {
  for (const double i : {-0.5, 0.5}) {
    for (const double j : {-0.5, 0.5}) {
      corners.push_back({raster.x + (column + i) * raster.cell_x, raster.y + (row + j) * raster.cell_y});
    }
  }
}

// Calls visit(column, row) for points of positive thickness.
template <class Visit>
void for_points_with_thickness(const Raster& thickness, const Visit& visit) {
  for (int row = 0; row < thickness.rows; ++row) {
    for (int column = 0; column < thickness.columns; ++column) {
      if (thickness.at(column, row) > 0.0) {
        visit(column, row);
      }
    }
  }
}

}  // namespace

config::Polyline2 corners_of(const config::Release& release) {
  config::Polyline2 corners;
  for (const config::Polyline2& ring : release.outlines) {
    corners.insert(corners.end(), ring.begin(), ring.end());
  }
  if (release.outlines.empty()) {
    for_points_with_thickness(release.thickness,
                              [&](int column, int row) { add_cell(release.thickness, column, row, corners); });
  }
  return corners;
}

double top_of(const config::Release& release, const Raster& ground) {
  const Raster& thickness = release.thickness;
  double top = -HUGE_VAL;
  for_points_with_thickness(thickness, [&](int column, int row) {
    const double height = bilinear(ground, thickness.x_of(column), thickness.y_of(row), Missing::nothing);
    top = std::fmax(top, height + thickness.at(column, row));
  });
  return top;
}

}  // namespace thawslide::sim
