#include "sim/map_grid.hpp"

#include <cmath>

#include "base/error.hpp"

namespace thawslide::sim {

namespace {

// Cells along one axis.
struct MapAxis {
  double first, cell;  // the first point; distance of points [m]
  double cells;
};

// An axis of cells that begin at `corner` or whole cells before it, over all from `from` to `to` [m].
MapAxis axis_over(double corner, double cell, double from, double to) {
  // An end that is a border but for round-off is one.
  const double sliver = 1e-6;  // of a cell
  const double before = std::ceil((corner - from) / cell - sliver), after = std::ceil((to - corner) / cell - sliver);
  return {corner + (0.5 - before) * cell, cell, before + after};
}

// The smallest size of two digits at which so many cells cover what these do [m].
double cell_for(const MapAxis& x, const MapAxis& y, double most_cells) {
  const double margin = 1.01;  // cells are whole and reach beyond the ends
  const double least = margin * std::sqrt(x.cells * x.cell * y.cells * y.cell / most_cells);
  const double digit = std::pow(10.0, std::floor(std::log10(least)) - 1.0);
  return std::ceil(least / digit) * digit;
}

}  // namespace

MapGrid map_grid_of(const config::Case& parameters, const config::Site& site) {
  const double asked = parameters.maps.cell;
  const auto axis_along = [&](std::size_t a, double first, double last, double distance) {
    const double domain_from = parameters.grid.min[a], domain_to = parameters.grid.max[a];
    if (!site.ground) {
      return axis_over(domain_from, asked > 0.0 ? asked : parameters.grid.cell, domain_from, domain_to);
    }
    const double corner = first - 0.5 * distance, end = last + 0.5 * distance;
    return axis_over(corner, asked > 0.0 ? asked : distance, std::min(corner, domain_from), std::max(end, domain_to));
  };
  const Raster none;
  const Raster& ground = site.ground ? *site.ground : none;
  const MapAxis x = axis_along(0, ground.x, ground.x_end(), ground.cell_x);
  const MapAxis y = axis_along(1, ground.y, ground.y_end(), ground.cell_y);
  if (x.cells * y.cells > most_map_cells) {
    throw UserError(fmt::format(
        "{}: maps of {:.0f} x {:.0f} cells of {:g} x {:g} m are too many: each would take {:.3g} GB of memory "
        "while it is written. Allowed: {:.3g} cells, {:.3g} GB. Give maps.cell, {:g} m or more.",
        config::place_of(parameters, "maps.cell"), x.cells, y.cells, x.cell, y.cell,
        x.cells * y.cells * sizeof(double) / 1e9, most_map_cells, most_map_cells * sizeof(double) / 1e9,
        cell_for(x, y, most_map_cells)));
  }
  return {x.first, y.first, x.cell, y.cell, static_cast<int>(x.cells), static_cast<int>(y.cells), site.crs};
}

}  // namespace thawslide::sim
