// Checks of cells that follow the terrain.
#include <fmt/format.h>

#include <cmath>

#include "config/checks.hpp"

namespace thawslide::config {

void check_cells(const Case& checked, Reading& reading) {
  if (!reading.are_valid({"terrain.type"}) || checked.terrain.kind == TerrainKind::none) {
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
      {!checked.frames.empty() && checked.terrain.kind != TerrainKind::flat, "a [frame] on ground that is not flat"},
      {is_closed(2 * v) || is_closed(2 * v + 1), "grid.boundary at the bottom or top of the domain"},
      {is_prescribed(2 * v) || is_prescribed(2 * v + 1), "heat.boundary at the bottom or top of the domain"},
  };
  std::string found;
  for (const auto& option : options) {
    found += option.is_requested ? (found.empty() ? "" : ", ") + std::string(option.what) : "";
  }
  if (!found.empty()) {
    reading.report("terrain.type",
                   fmt::format("terrain.type: cells that follow the terrain do not support all options of this case "
                               "(found {}; allowed: none of these). Remove them: the terrain is the lower boundary. A "
                               "[frame] needs terrain.type = \"flat\".",
                               found));
  }
  if (reading.are_valid({"terrain.slope", "grid.steepest"}) && checked.terrain.kind == TerrainKind::plane &&
      std::abs(checked.terrain.slope) > checked.grid.steepest) {
    reading.report(
        "terrain.slope",
        fmt::format("terrain.slope is {:g} degrees, steeper than cells may follow the terrain (grid.steepest "
                    "is {:g} degrees; allowed: up to 85). Increase grid.steepest, or reduce terrain.slope.",
                    checked.terrain.slope, checked.grid.steepest));
  }
}

}  // namespace thawslide::config
