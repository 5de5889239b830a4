// Width of the edges of an excavated release that lets the slide leave the pit. A taper of width w makes its lower wall
// a ramp that rises by 2 t / w against the terrain, t: thickness at the edge. If that is at most the slope s of the
// terrain, the base falls everywhere: w = 2 t / s in whole cells, at least 3 t (34 degrees), at most 10 t (11 degrees).
#include <algorithm>
#include <cmath>

#include "config/case_proposal.hpp"
#include "config/site.hpp"

namespace thawslide::config {

namespace {

constexpr double least_widths = 3.0, most_widths = 10.0;  // in multiples of the thickness

// Values at the points of the thickness, and of `margin` points around them; `beyond`: value where there is none.
Raster window_of(const Raster& values, const Raster& thickness, int margin, double beyond) {
  const auto first = [margin](double coordinate, double origin, double cell) {
    return static_cast<int>(std::lround((coordinate - origin) / cell)) - margin;
  };
  const int left = first(thickness.x, values.x, values.cell_x), bottom = first(thickness.y, values.y, values.cell_y);
  Raster window;
  window.columns = thickness.columns + 2 * margin;
  window.rows = thickness.rows + 2 * margin;
  window.values.resize(window.index(0, window.rows), beyond);
  for_each_point(window, [&](int column, int row, double& value) {
    const int i = left + column, j = bottom + row;
    if (i >= 0 && j >= 0 && i < values.columns && j < values.rows) {
      value = values.at(i, j);
    }
  });
  return window;
}

// Steps along rows, columns and diagonals to the nearest point for which `is(value)` holds (Rosenfeld and Pfaltz 1968).
template <class Is>
Raster steps_to(const Raster& window, const Is& is) {
  Raster steps = window;
  for (double& value : steps.values) {
    value = is(value) ? 0.0 : window.columns + window.rows;
  }
  for (const int direction : {1, -1}) {
    for (int r = 0; r < window.rows; ++r) {
      for (int c = 0; c < window.columns; ++c) {
        const int row = direction > 0 ? r : window.rows - 1 - r, column = direction > 0 ? c : window.columns - 1 - c;
        double& here = steps.values[steps.index(column, row)];
        for (const auto& [i, j] : {std::pair(column - direction, row), std::pair(column - 1, row - direction),
                                   std::pair(column, row - direction), std::pair(column + 1, row - direction)}) {
          if (i >= 0 && i < window.columns && j >= 0 && j < window.rows) {
            here = std::min(here, steps.at(i, j) + 1.0);
          }
        }
      }
    }
  }
  return steps;
}

bool is_release(double thickness) { return thickness > 0.0; }

}  // namespace

double slope_below(const Raster& dem, const Raster& thickness) {
  const Raster ground = window_of(dem, thickness, 1, std::nan(""));
  double x = 0.0, y = 0.0, points = 0.0;
  for_points_of_release(thickness, [&](int column, int row) {
    const double dx = ground.at(column + 2, row + 1) - ground.at(column, row + 1);
    const double dy = ground.at(column + 1, row + 2) - ground.at(column + 1, row);
    if (!std::isnan(dx + dy)) {
      x += dx / (2.0 * dem.cell_x);
      y += dy / (2.0 * dem.cell_y);
      points += 1.0;
    }
  });
  return points > 0.0 ? std::hypot(x, y) / points : 0.0;
}

EdgeTaper propose_taper(const Raster& dem, const Raster& thickness) {
  const double cell = std::min(dem.cell_x, dem.cell_y);
  const double thickest = *std::max_element(thickness.values.begin(), thickness.values.end());
  const int margin = 2 + static_cast<int>(std::ceil(0.5 * most_widths * thickest / cell));
  const Raster release = window_of(thickness, thickness, margin, 0.0);
  const Raster ground = window_of(dem, thickness, margin, std::nan(""));
  const Raster inside = steps_to(release, [](double value) { return !is_release(value); });
  const Raster outside = steps_to(release, is_release);
  double to_unknown = release.columns + release.rows;
  double edge = 0.0;  // maximum thickness next to the edge; the outline may cut the cells of the edge points themselves
  for_each_point(release, [&](int column, int row, double value) {
    if (std::isnan(ground.at(column, row))) {
      to_unknown = std::min(to_unknown, outside.at(column, row));
    }
    if (inside.at(column, row) <= 2.0) {
      edge = std::max(edge, value);
    }
  });
  const double half_width = *std::max_element(inside.values.begin(), inside.values.end());

  EdgeTaper taper;
  taper.slope = slope_below(dem, thickness);
  const double wanted = std::clamp(2.0 * edge / std::max(taper.slope, 1e-9), least_widths * edge, most_widths * edge);
  const double wanted_cells = std::ceil(wanted / cell - 1e-9);
  // An upright edge between DEM points is a ramp one cell wide, as steep as a taper of two cells.
  taper.wanted = wanted_cells > 2.0 ? wanted_cells * cell : 0.0;
  const double available = std::max(0.0, 2.0 * (std::min(to_unknown, half_width) - 1.0) * cell);
  const double width = std::min(taper.wanted, available);
  taper.width = width > 2.0 * cell ? width : 0.0;
  taper.steepest = 2.0 * edge / std::max(taper.width, 2.0 * cell);
  return taper;
}

}  // namespace thawslide::config
