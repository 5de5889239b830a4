// Checks of the erodible bed.
#include <fmt/format.h>

#include <algorithm>

#include "config/checks.hpp"

namespace thawslide::config {

namespace {

void check_depth(const Case& checked, Reading& reading) {
  const InitialField& depth = checked.bed.depth;
  const std::string key = "bed.depth";
  if (!reading.are_valid({key})) {
    return;
  }
  if (depth.over == InitialField::Over::depth || depth.over == InitialField::Over::attribute) {
    reading.report(key, fmt::format("{} is given by {}; allowed: a number, {{ x = [...], value = [...] }} or {{ raster "
                                    "= \"FILE\" }}, since a bed has no polygons and lies on the ground.",
                                    key, depth.over == InitialField::Over::depth ? "depth" : "an attribute"));
  } else if (depth.is_map()) {
    if (reading.are_valid({"terrain.type"}) && checked.terrain.kind != TerrainKind::dem) {
      reading.report_misfit({key, "terrain.type"},
                            fmt::format("{} is a raster, and terrain.type is not \"dem\"; maps lie on a DEM. Give a "
                                        "number or a table over x, or set terrain.type = \"dem\" and terrain.file.",
                                        key));
    }
  } else if (!depth.table.value.empty() && reading.are_valid({"grid.cell"})) {
    const double deepest = *std::max_element(depth.table.value.begin(), depth.table.value.end());
    if (deepest > checked.grid.cell) {
      reading.report_misfit(
          {key, "grid.cell"},
          fmt::format("{} is {} m, more than grid.cell, which is {} m; the ground is not lowered as the bed is "
                      "entrained. Make the bed thinner, or represent the bed by a body on lower terrain.",
                      key, deepest, checked.grid.cell));
    }
  }
}

}  // namespace

void check_bed(const Case& checked, Reading& reading) {
  if (!reading.are_valid({"bed.law"}) || checked.bed.law == BedLaw::none) {
    return;
  }
  check_depth(checked, reading);
  check_material(checked, "bed", checked.bed.material, reading);
  if (reading.are_valid({"terrain.type"}) && checked.terrain.kind == TerrainKind::none) {
    reading.report_misfit(
        {"bed.law", "terrain.type"},
        "bed.law is given, and the case has no terrain that a bed could lie on. Remove [bed], or give "
        "terrain.type.");
  }
}

}  // namespace thawslide::config
