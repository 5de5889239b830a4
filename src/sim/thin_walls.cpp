#include "sim/thin_walls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/rounding.hpp"

namespace thawslide::sim {

namespace {

struct Wall {
  double height = 0.0;  // above the higher of its two sides [m]
  std::array<double, 2> point{};
};

Wall highest_on_profile(const config::ProfileTable& profile, double from, double to, double cell) {
  Wall highest;
  const double step = cell / 16.0;
  const auto steps = static_cast<std::int64_t>(std::floor((to - from) / step));
  for (std::int64_t k = 0; k <= steps; ++k) {
    const double x = from + static_cast<double>(k) * step;
    const double side = std::max(profile.terrain_at(x - 0.5 * cell), profile.terrain_at(x + 0.5 * cell));
    if (const double height = profile.terrain_at(x) - side; height > highest.height) {
      highest = {height, {x, 0.0}};
    }
  }
  return highest;
}

// Searches along the axes and the diagonals. Points more than half a cell apart cannot form so thin a wall.
Wall highest_on_raster(const Raster& ground, const config::Grid& grid) {
  Wall highest;
  for (const std::array<int, 2> direction : {std::array{1, 0}, std::array{0, 1}, std::array{1, 1}, std::array{1, -1}}) {
    const double distance = std::hypot(direction[0] * ground.cell_x, direction[1] * ground.cell_y);
    const int reach = static_cast<int>(0.5 * grid.cell / distance);
    const int columns = reach * direction[0], rows = reach * direction[1];
    for (int row = std::abs(rows); reach > 0 && row < ground.rows - std::abs(rows); ++row) {
      for (int column = columns; column < ground.columns - columns; ++column) {
        const double side = std::max(ground.at(column - columns, row - rows), ground.at(column + columns, row + rows));
        const double height = ground.at(column, row) - side, x = ground.x + column * ground.cell_x,
                     y = ground.y + row * ground.cell_y;
        if (height > highest.height && x >= grid.min[0] && x <= grid.max[0] && y >= grid.min[1] && y <= grid.max[1]) {
          highest = {height, {x, y}};
        }
      }
    }
  }
  return highest;
}

}  // namespace

std::string warning_of_thin_walls(const config::Case& parameters, const config::Site& site) {
  const double cell = parameters.grid.cell;
  Wall wall;
  if (parameters.terrain.kind == config::TerrainKind::profile) {
    wall =
        highest_on_profile(config::profile_of(parameters, site), parameters.grid.min[0], parameters.grid.max[0], cell);
  } else if (site.ground) {
    wall = highest_on_raster(*site.ground, parameters.grid);
  }
  if (!(wall.height > cell)) {
    return "";
  }
  const std::string point =
      parameters.general.dimension == 3
          ? fmt::format("x = {}, y = {} m", coordinate_text(wall.point[0]), coordinate_text(wall.point[1]))
          : fmt::format("x = {} m", coordinate_text(wall.point[0]));
  return fmt::format(
      "grid.cell: at {} the terrain has a wall thinner than a cell ({:g} m), {} m high. A slide can enter it, and "
      "bodies on its two sides push each other through it. Use cells no larger than the wall is thick, or remove it.",
      point, cell, rounded_text(wall.height, 2));
}

}  // namespace thawslide::sim
