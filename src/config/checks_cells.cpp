// Checks of cells that follow the terrain.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/checks.hpp"

namespace thawslide::config {

void check_cells(const Case& checked, Reading& reading) {
  if (!reading.are_valid({"grid.follows_terrain"}) || !checked.grid.follows_terrain ||
      checked.terrain.kind == TerrainKind::none) {
    return;
  }
  const auto v = static_cast<std::size_t>(checked.general.dimension - 1);
  const auto is_prescribed = [&](std::size_t side) {
    return checked.heat.boundary[side].kind != HeatBoundaryKind::insulated;
  };
  const auto is_closed = [&](std::size_t side) { return checked.grid.boundary[side] != BoundaryKind::open; };
  const struct {
    bool is_requested;
    const char* what;
  } options[] = {
      {checked.terrain.form == TerrainForm::rigid_points, "terrain.representation = \"rigid_points\""},
      {!checked.frames.empty() && checked.terrain.kind != TerrainKind::flat, "a [frame] on ground that is not flat"},
      {is_closed(2 * v) || is_closed(2 * v + 1), "grid.boundary at the bottom or top of the domain"},
      {is_prescribed(2 * v) || is_prescribed(2 * v + 1), "heat.boundary at the bottom or top of the domain"},
  };
  std::string found;
  for (const auto& option : options) {
    found += option.is_requested ? (found.empty() ? "" : ", ") + std::string(option.what) : "";
  }
  if (!found.empty()) {
    reading.report("grid.follows_terrain",
                   fmt::format("grid.follows_terrain: cells that follow the terrain do not support all options of this "
                               "case (found {}; allowed: none of these). Set grid.follows_terrain = false.",
                               found));
  }
  if (reading.are_valid({"terrain.slope", "grid.steepest"}) && checked.terrain.kind == TerrainKind::plane &&
      std::abs(checked.terrain.slope) > checked.grid.steepest) {
    reading.report(
        "terrain.slope",
        fmt::format("terrain.slope is {:g} degrees, steeper than cells may follow the terrain (grid.steepest "
                    "is {:g} degrees; allowed: up to 85). Increase grid.steepest, or set "
                    "grid.follows_terrain = false.",
                    checked.terrain.slope, checked.grid.steepest));
  }
}

}  // namespace thawslide::config
