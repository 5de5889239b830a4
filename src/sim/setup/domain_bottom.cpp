#include "sim/setup/domain_bottom.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/rounding.hpp"

namespace thawslide::sim {

namespace {

// Lowest point of a profile or a DEM [m] in the domain, or next to it.
double lowest_terrain(const config::Case& parameters, const config::Site& site) {
  const config::Grid& grid = parameters.grid;
  double lowest = HUGE_VAL;
  if (parameters.terrain.kind == config::TerrainKind::dem) {
    const Raster& ground = *site.ground;
    const auto is_near = [&](double place, double spacing, std::size_t axis) {
      return place > grid.min[axis] - spacing && place < grid.max[axis] + spacing;
    };
    for (int row = 0; row < ground.rows; ++row) {
      for (int column = 0; column < ground.columns && is_near(ground.y_of(row), ground.cell_y, 1); ++column) {
        if (is_near(ground.x_of(column), ground.cell_x, 0)) {
          lowest = std::fmin(lowest, ground.at(column, row));  // no data: NaN
        }
      }
    }
    return lowest;
  }
  const config::ProfileTable profile = config::profile_of(parameters, site);
  const std::size_t points = profile.distance.size();
  for (std::size_t k = 0; k < points; ++k) {
    const double before = profile.distance[k > 0 ? k - 1 : 0], after = profile.distance[k + 1 < points ? k + 1 : k];
    if (after > grid.min[0] && before < grid.max[0]) {
      lowest = std::min(lowest, profile.terrain[k]);
    }
  }
  return lowest;
}

}  // namespace

double bottom_of_domain(const config::Case& parameters, const config::Site& site) {
  const auto axis = static_cast<std::size_t>(parameters.general.dimension - 1);
  const config::Grid& grid = parameters.grid;
  if (!config::has_terrain(parameters)) {
    return grid.min[axis];
  }
  const double lowest = lowest_terrain(parameters, site);
  const double bottom = lowest < grid.min[axis] ? lowest - grid.cell : grid.min[axis];
  const double cells = (grid.max[axis] - bottom) / grid.cell;
  const bool is_whole = std::abs(cells - std::round(cells)) <= 1e-6 * cells;
  return is_whole && bottom == grid.min[axis] ? bottom : grid.max[axis] - std::ceil(cells - 1e-6) * grid.cell;
}

std::string note_of_bottom(const config::Case& parameters, const config::Site& site) {
  const auto axis = static_cast<std::size_t>(parameters.general.dimension - 1);
  if (bottom_of_domain(parameters, site) >= parameters.grid.min[axis] - parameters.grid.cell) {
    return "";
  }
  return fmt::format(
      "note: {}: the elevation in grid.min, {} m, is above the lowest terrain, {} m. It has no effect, because cells "
      "begin at the terrain.",
      config::location_of(parameters, "grid.min"), coordinate_text(parameters.grid.min[axis]),
      coordinate_text(lowest_terrain(parameters, site)));
}

}  // namespace thawslide::sim
