// Checks of the ground: parameters of its laws, and extent of substrates.
#include <fmt/format.h>

#include "config/checks.hpp"
#include "config/strips.hpp"
#include "physics/basal/laws.hpp"

namespace thawslide::config {

namespace {

void check_numbers(const LawNumbers& numbers, const std::string& table, Reading& reading) {
  const double least = numbers(physics::basal::min_solid_fraction), most = numbers(physics::basal::max_solid_fraction);
  const double initial = numbers(physics::basal::initial_cohesion);
  const double residual = numbers(physics::basal::residual_cohesion);
  const std::string least_key = table + ".min_solid_fraction", most_key = table + ".max_solid_fraction";
  if (reading.are_valid({least_key, most_key}) && least >= most) {
    reading.report_misfit({most_key, least_key},
                          fmt::format("{} is {}, not above {}, which is {}; Eq. 25 divides by their difference. Make "
                                      "the one larger or the other smaller.",
                                      most_key, most, least_key, least));
  }
  const std::string initial_key = table + ".cohesion", residual_key = table + ".residual_cohesion";
  if (reading.are_valid({initial_key, residual_key}) && residual > initial) {
    reading.report_misfit({residual_key, initial_key},
                          fmt::format("{} is {} Pa, above {}, which is {} Pa; cohesion along the ground is only lost. "
                                      "Give a residual at most the cohesion.",
                                      residual_key, residual, initial_key, initial));
  }
}

void check_strip(const Case& checked, const Substrate& substrate, const std::string& table, Reading& reading) {
  const std::string from = table + ".x_min", to = table + ".x_max";
  if (!reading.are_valid({from, to})) {
    return;
  }
  if (!reading.is_given(from) && !reading.is_given(to)) {
    const bool on_dem = checked.terrain.kind == TerrainKind::dem;
    reading.report(
        table,
        fmt::format("[{}] does not specify its area. Give x_min, x_max or both{}; [basal] applies everywhere else.",
                    table, on_dem ? ", or outline, or raster and code" : ""));
  } else if (substrate.x_min >= substrate.x_max) {
    reading.report_misfit({to, from}, fmt::format("{} is {} m, not above {}, which is {} m; a substrate lies between "
                                                  "them. Make the one larger or the other smaller.",
                                                  to, substrate.x_max, from, substrate.x_min));
  } else if (reading.are_valid({"grid.min", "grid.max"}) &&
             (substrate.x_min >= checked.grid.max[0] || substrate.x_max <= checked.grid.min[0])) {
    const bool beyond = substrate.x_min >= checked.grid.max[0];
    reading.report_misfit(
        {beyond ? from : to, beyond ? "grid.max" : "grid.min"},
        fmt::format("{} is {} m, and the domain reaches from x = {} to {} m; the substrate lies outside. Check the "
                    "number, or widen the domain.",
                    beyond ? from : to, beyond ? substrate.x_min : substrate.x_max, checked.grid.min[0],
                    checked.grid.max[0]));
  }
}

void check_map(const Case& checked, const Substrate& substrate, const std::string& table, Reading& reading) {
  const std::string outline = table + ".outline", raster = table + ".raster";
  const std::string& key = substrate.outline.empty() ? raster : outline;
  if (!substrate.outline.empty() && !substrate.raster.empty()) {
    reading.report_misfit({raster, outline}, fmt::format("{} and {} are both given; allowed: one of them, since each "
                                                         "says where the substrate lies. Remove one.",
                                                         outline, raster));
  } else if (reading.are_valid({"terrain.type"}) && checked.terrain.kind != TerrainKind::dem) {
    reading.report_misfit({key, "terrain.type"},
                          fmt::format("{} is given, and terrain.type is not \"dem\"; maps lie on a DEM. Give x_min and "
                                      "x_max instead, or set terrain.type = \"dem\" and terrain.file.",
                                      key));
  }
}

// Checks for strips that overlap, or leave a gap too narrow for the grid.
void check_neighbours(const Case& checked, Reading& reading) {
  const std::vector<Strip> strips = strips_of(checked);
  for (std::size_t k = 1; k < strips.size(); ++k) {
    const Strip &one = strips[k - 1], &other = strips[k];
    const std::string to = "substrate." + one.name + ".x_max", from = "substrate." + other.name + ".x_min";
    if (!reading.are_valid({to, from, "substrate." + one.name, "substrate." + other.name, "grid.cell"})) {
      continue;
    }
    const double gap = other.from - one.to;
    if (gap < 0.0) {
      reading.report_misfit({from, to},
                            fmt::format("the substrates {} and {} overlap: {} is {} m, and {} is {} m; a place has one "
                                        "substrate. End the one where the other begins.",
                                        one.name, other.name, from, other.from, to, one.to));
    } else if (gap > 0.0 && gap < checked.grid.cell) {
      reading.report_misfit(
          {from, to}, fmt::format("between the substrates {} and {} there is a gap of {:g} m, less than a cell of the "
                                  "grid: {} is {} m, and {} is {} m. Let them meet, or leave a gap of at least {} m.",
                                  one.name, other.name, gap, to, one.to, from, other.from, checked.grid.cell));
    }
  }
}

// Checks for substrates of one raster with the same code.
void check_codes(const Case& checked, Reading& reading) {
  for (auto one = checked.substrates.begin(); one != checked.substrates.end(); ++one) {
    for (auto other = checked.substrates.begin(); other != one; ++other) {
      const std::string key = "substrate." + one->first + ".code", former = "substrate." + other->first + ".code";
      if (!one->second.raster.empty() && one->second.raster == other->second.raster &&
          one->second.code == other->second.code && reading.are_valid({key, former})) {
        reading.report_misfit({key, former}, fmt::format("{} and {} are both {}, of the same raster; a place has one "
                                                         "substrate. Give each a code of its own.",
                                                         former, key, one->second.code));
      }
    }
  }
}

}  // namespace

void check_grounds(const Case& checked, Reading& reading) {
  check_numbers(checked.basal.numbers, "basal", reading);
  for (const auto& [name, substrate] : checked.substrates) {
    const std::string table = "substrate." + name;
    check_numbers(substrate.numbers, table, reading);
    if (reading.are_valid({"terrain.type"}) && checked.terrain.kind == TerrainKind::none) {
      reading.report_misfit(
          {table, "terrain.type"},
          fmt::format(
              "[{}] specifies what bodies slide on, and the case has no terrain. Remove it, or give terrain.type.",
              table));
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

}  // namespace thawslide::config
