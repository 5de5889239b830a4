#include "sim/map_grid.hpp"

#include <limits>

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
  constexpr double most_cells = std::numeric_limits<std::int32_t>::max();
  if (x.cells * y.cells > most_cells) {
    throw UserError(fmt::format(
        "{}: maps of {:.0f} x {:.0f} cells of {:g} x {:g} m are too many; allowed: {:.0f} cells. Use a larger "
        "maps.cell.",
        config::place_of(parameters, "maps.cell"), x.cells, y.cells, x.cell, y.cell, most_cells));
  }
  return {x.first, y.first, x.cell, y.cell, static_cast<int>(x.cells), static_cast<int>(y.cells), site.crs};
}

}  // namespace thawslide::sim
