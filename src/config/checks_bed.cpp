// Checks of the erodible bed.
#include <fmt/format.h>

#include <algorithm>

#include "config/checks.hpp"
#include "config/input_limits.hpp"

namespace thawslide::config {

namespace {

void check_depth(const Case& checked, Reading& reading) {
  const InitialField& depth = checked.bed.depth;
  const std::string key = "bed.depth";
  if (!reading.are_valid({key})) {
    return;
  }
  if (depth.over == InitialField::Over::depth) {
    reading.report(key,
                   fmt::format("{} is given by depth; allowed: a number, {{ x = [...], value = [...] }}, {{ "
                               "attribute = \"NAME\" }} or {{ raster = \"FILE\" }}, since a bed lies on the ground.",
                               key));
  } else if (depth.over == InitialField::Over::attribute) {
    if (checked.bed.outline.empty() && reading.are_valid({"bed.outline"})) {
      reading.report_misfit(
          {key, "bed.outline"},
          fmt::format("{} is the attribute \"{}\", and bed.outline is not given; there are no polygons to have it. "
                      "Give the file of polygons, or a number, a table or a raster.",
                      key, shown(depth.source)));
    }
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

void check_outline(const Case& checked, Reading& reading) {
  const InitialField::Over over = checked.bed.depth.over;
  const std::string key = "bed.outline", depth = "bed.depth";
  if (checked.bed.outline.empty() || !reading.are_valid({key})) {
    return;
  }
  if (reading.are_valid({"terrain.type"}) && checked.terrain.kind != TerrainKind::dem) {
    reading.report_misfit({key, "terrain.type"},
                          fmt::format("{} is given, and terrain.type is not \"dem\"; maps lie on a DEM. Remove {}, or "
                                      "set terrain.type = \"dem\" and terrain.file.",
                                      key, key));
  } else if (reading.are_valid({depth}) && (over == InitialField::Over::raster || over == InitialField::Over::x)) {
    reading.report_misfit(
        {key, depth},
        fmt::format("{} is given, and {} is {}; allowed with polygons: a number or {{ attribute = "
                    "\"NAME\" }}, since each says where the bed lies. Remove {}, or change {}.",
                    key, depth, over == InitialField::Over::raster ? "a raster" : "a table over x", key, depth));
  }
}

}  // namespace

void check_bed(const Case& checked, Reading& reading) {
  if (!reading.are_valid({"bed.law"}) || checked.bed.law == BedLaw::none) {
    return;
  }
  check_depth(checked, reading);
  check_outline(checked, reading);
  check_material(checked, "bed", checked.bed.material, reading);
  if (reading.are_valid({"terrain.type"}) && checked.terrain.kind == TerrainKind::none) {
    reading.report_misfit(
        {"bed.law", "terrain.type"},
        "bed.law is given, and the case has no terrain that a bed could lie on. Remove [bed], or give "
        "terrain.type.");
  }
}

}  // namespace thawslide::config
