// Checks of the ground: parameters of its laws, extent of substrates, and the erodible bed.
#include <algorithm>

#include "config/checks.hpp"
#include "config/grounds.hpp"
#include "config/input_limits.hpp"
#include "physics/basal/laws.hpp"

namespace thawslide::config {

namespace {

void check_numbers(const LawNumbers& numbers, const std::string& table, Reading& reading) {
  const double least = numbers(physics::basal::min_solid_fraction), most = numbers(physics::basal::max_solid_fraction);
  const double initial = numbers(physics::basal::initial_cohesion);
  const double residual = numbers(physics::basal::residual_cohesion);
  reading.refuse_if(least >= most, {table + ".max_solid_fraction", table + ".min_solid_fraction"},
                    "{0}.max_solid_fraction is {1}, not above {0}.min_solid_fraction, which is {2}; Eq. 25 divides by "
                    "their difference. Make the one larger or the other smaller.",
                    table, most, least);
  reading.refuse_if(
      residual > initial, {table + ".residual_cohesion", table + ".cohesion"},
      "{0}.residual_cohesion is {1} Pa, above {0}.cohesion, which is {2} Pa; cohesion along the ground is "
      "only lost. Give a residual at most the cohesion.",
      table, residual, initial);
}

void check_strip(const Case& checked, const Substrate& substrate, const std::string& table, Reading& reading) {
  const std::string from = table + ".x_min", to = table + ".x_max";
  if (!reading.are_valid({from, to})) {
    return;
  }
  if (!reading.is_given(from) && !reading.is_given(to)) {
    const bool on_dem = checked.terrain.kind == TerrainKind::dem;
    reading.report({table},
                   "[{}] does not specify its area. Give x_min, x_max or both{}; [basal] applies everywhere else.",
                   table, on_dem ? ", or outline, or raster and code" : "");
    return;
  }
  reading.refuse_if(
      substrate.x_min >= substrate.x_max, {to, from},
      "{} is {} m, not above {}, which is {} m; a substrate lies between them. Make the one larger or the "
      "other smaller.",
      to, substrate.x_max, from, substrate.x_min);
  const bool beyond = substrate.x_min >= checked.grid.max[0];
  if (reading.are_valid({from, to, "grid.min", "grid.max"})) {
    reading.refuse_if(
        beyond || substrate.x_max <= checked.grid.min[0], {beyond ? from : to, beyond ? "grid.max" : "grid.min"},
        "{} is {} m, and the domain reaches from x = {} to {} m; the substrate lies outside. Check the "
        "number, or widen the domain.",
        beyond ? from : to, beyond ? substrate.x_min : substrate.x_max, checked.grid.min[0], checked.grid.max[0]);
  }
}

void check_map(const Case& checked, const Substrate& substrate, const std::string& table, Reading& reading) {
  const std::string outline = table + ".outline", raster = table + ".raster";
  const std::string& key = substrate.outline.empty() ? raster : outline;
  const bool are_both = !substrate.outline.empty() && !substrate.raster.empty();
  reading.refuse_if(are_both, {raster, outline},
                    "{} and {} are both given; allowed: one of them, since each says where the substrate lies. Remove "
                    "one.",
                    outline, raster);
  reading.refuse_if(!are_both && checked.terrain.kind != TerrainKind::dem, {key, "terrain.type"},
                    "{} is given, and terrain.type is not \"dem\"; maps lie on a DEM. Give x_min and x_max instead, or "
                    "set terrain.type = \"dem\" and terrain.file.",
                    key);
}

// Checks for strips that overlap.
void check_neighbours(const Case& checked, Reading& reading) {
  const std::vector<Strip> strips = strips_of(checked);
  for (std::size_t k = 1; k < strips.size(); ++k) {
    const Strip &one = strips[k - 1], &other = strips[k];
    const std::string to = "substrate." + one.name + ".x_max", from = "substrate." + other.name + ".x_min";
    if (!reading.are_valid({to, from, "substrate." + one.name, "substrate." + other.name})) {
      continue;
    }
    reading.refuse_if(
        other.from < one.to, {from, to},
        "the substrates {} and {} overlap: {} is {} m, and {} is {} m; a place has one substrate. End the "
        "one where the other begins.",
        one.name, other.name, from, other.from, to, one.to);
  }
}

// Checks for substrates of one raster with the same code.
void check_codes(const Case& checked, Reading& reading) {
  for (auto one = checked.substrates.begin(); one != checked.substrates.end(); ++one) {
    for (auto other = checked.substrates.begin(); other != one; ++other) {
      const std::string key = "substrate." + one->first + ".code", former = "substrate." + other->first + ".code";
      reading.refuse_if(!one->second.raster.empty() && one->second.raster == other->second.raster &&
                            one->second.code == other->second.code,
                        {key, former},
                        "{} and {} are both {}, of the same raster; a place has one substrate. Give each a code of its "
                        "own.",
                        former, key, one->second.code);
    }
  }
}

void check_bed_depth(const Case& checked, Reading& reading) {
  const InitialField& depth = checked.bed.depth;
  const std::string key = "bed.depth";
  if (!reading.are_valid({key})) {
    return;
  }
  if (depth.over == InitialField::Over::depth) {
    reading.report({key},
                   "{} is given by depth; allowed: a number, {{ x = [...], value = [...] }}, {{ "
                   "attribute = \"NAME\" }} or {{ raster = \"FILE\" }}, since a bed lies on the ground.",
                   key);
  } else if (depth.over == InitialField::Over::attribute) {
    reading.refuse_if(
        checked.bed.outline.empty(), {key, "bed.outline"},
        "{} is the attribute \"{}\", and bed.outline is not given; there are no polygons to have it. Give "
        "the file of polygons, or a number, a table or a raster.",
        key, shown(depth.source));
  } else if (depth.is_map()) {
    reading.refuse_if(
        checked.terrain.kind != TerrainKind::dem, {key, "terrain.type"},
        "{} is a raster, and terrain.type is not \"dem\"; maps lie on a DEM. Give a number or a table over "
        "x, or set terrain.type = \"dem\" and terrain.file.",
        key);
  } else if (!depth.table.value.empty()) {
    const double deepest = *std::max_element(depth.table.value.begin(), depth.table.value.end());
    reading.refuse_if(
        deepest > checked.grid.cell, {key, "grid.cell"},
        "{} is {} m, more than grid.cell, which is {} m; the ground is not lowered as the bed is entrained. "
        "Make the bed thinner, or represent the bed by a body on lower terrain.",
        key, deepest, checked.grid.cell);
  }
}

void check_bed_outline(const Case& checked, Reading& reading) {
  const InitialField::Over over = checked.bed.depth.over;
  const std::string key = "bed.outline", depth = "bed.depth";
  if (checked.bed.outline.empty()) {
    return;
  }
  reading.refuse_if(
      checked.terrain.kind != TerrainKind::dem, {key, "terrain.type"},
      "{0} is given, and terrain.type is not \"dem\"; maps lie on a DEM. Remove {0}, or set terrain.type = "
      "\"dem\" and terrain.file.",
      key);
  reading.refuse_if(
      over == InitialField::Over::raster || over == InitialField::Over::x, {key, depth},
      "{0} is given, and {1} is {2}; allowed with polygons: a number or {{ attribute = \"NAME\" }}, since "
      "each says where the bed lies. Remove {0}, or change {1}.",
      key, depth, over == InitialField::Over::raster ? "a raster" : "a table over x");
}

}  // namespace

void check_grounds(const Case& checked, Reading& reading) {
  check_numbers(checked.basal.numbers, "basal", reading);
  for (const auto& [name, substrate] : checked.substrates) {
    const std::string table = "substrate." + name;
    check_numbers(substrate.numbers, table, reading);
    if (reading.are_valid({"terrain.type"}) && checked.terrain.kind == TerrainKind::none) {
      reading.report(
          {table, "terrain.type"},
          "[{}] specifies what bodies slide on, and the case has no terrain. Remove it, or give terrain.type.", table);
    } else if (!reading.are_valid({table + ".outline", table + ".raster"})) {
      continue;  // already reported
    } else if (substrate.is_strip()) {
      check_strip(checked, substrate, table, reading);
    } else {
      check_map(checked, substrate, table, reading);
    }
  }
  check_neighbours(checked, reading);
  check_codes(checked, reading);
}

void check_bed(const Case& checked, Reading& reading) {
  if (!reading.are_valid({"bed.law"}) || checked.bed.law == BedLaw::none) {
    return;
  }
  check_bed_depth(checked, reading);
  check_bed_outline(checked, reading);
  check_material(checked, "bed", checked.bed.material, reading);
  reading.refuse_if(checked.terrain.kind == TerrainKind::none, {"bed.law", "terrain.type"},
                    "bed.law is given, and the case has no terrain that a bed could lie on. Remove [bed], or give "
                    "terrain.type.");
}

}  // namespace thawslide::config
