#include "config/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace thawslide::config {

namespace {

constexpr double fewest_cells = 2.0;  // of the domain along each axis
const char* const axis_names[] = {"x", "y", "z"};

void check_grid(const Case& checked, Reading& reading) {
  const Grid& grid = checked.grid;
  if (!reading.sound({"grid.cell", "grid.min", "grid.max"})) {
    return;
  }
  for (std::size_t a = 0; a < static_cast<std::size_t>(checked.general.dimension); ++a) {
    const double length = grid.max[a] - grid.min[a];
    if (!(length > 0.0)) {
      reading.report("grid.max",
                     fmt::format("grid.max is {} along {}, not above grid.min, which is {}; give the domain a "
                                 "highest corner above its lowest one.",
                                 grid.max[a], axis_names[a], grid.min[a]));
      return;
    }
    const double cells = length / grid.cell;
    if (cells < fewest_cells) {
      reading.report("grid.cell",
                     fmt::format("grid.cell is {} m, and the domain is {} m long along {}; allowed: at least "
                                 "{} cells along each axis. Make the cell smaller or the domain larger.",
                                 grid.cell, length, axis_names[a], fewest_cells));
      return;
    }
    if (std::abs(cells - std::round(cells)) > 1e-6 * cells) {
      reading.report("grid.max",
                     fmt::format("the domain is {} m long along {}, which is {:.6g} cells of {} m; allowed: a "
                                 "whole number. Move grid.max along {} to {}.",
                                 length, axis_names[a], cells, grid.cell, axis_names[a],
                                 grid.min[a] + std::round(cells) * grid.cell));
    }
  }
}

void check_materials(const Case& checked, Reading& reading) {
  for (const auto& [name, material] : checked.materials) {
    const std::string table = "material." + name;
    if (reading.sound({table + ".cohesion", table + ".residual_cohesion"}) &&
        material.residual_cohesion > material.cohesion) {
      reading.report(table + ".residual_cohesion",
                     fmt::format("{}.residual_cohesion is {} Pa, above {}.cohesion, which is {} Pa; softening takes "
                                 "cohesion away. Give a residual at most the cohesion.",
                                 table, material.residual_cohesion, table, material.cohesion));
    }
    if (reading.sound({table + ".dilation_angle", table + ".friction_angle"}) &&
        material.dilation_angle > material.friction_angle) {
      reading.report(
          table + ".dilation_angle",
          fmt::format("{}.dilation_angle is {} degrees, above {}.friction_angle, which is {} degrees; allowed: at "
                      "most the friction angle, else plastic flow makes energy.",
                      table, material.dilation_angle, table, material.friction_angle));
    }
  }
}

void check_basal(const Case& checked, Reading& reading) {
  const Basal& basal = checked.basal;
  if (reading.sound({"basal.min_solid_fraction", "basal.max_solid_fraction"}) &&
      basal.min_solid_fraction >= basal.max_solid_fraction) {
    reading.report(
        "basal.max_solid_fraction",
        fmt::format("basal.max_solid_fraction is {}, not above basal.min_solid_fraction, which is {}; Eq. 25 "
                    "divides by their difference.",
                    basal.max_solid_fraction, basal.min_solid_fraction));
  }
  if (reading.sound({"basal.cohesion", "basal.residual_cohesion"}) && basal.residual_cohesion > basal.cohesion) {
    reading.report(
        "basal.residual_cohesion",
        fmt::format("basal.residual_cohesion is {} Pa, above basal.cohesion, which is {} Pa; cohesion along the "
                    "ground is only lost. Give a residual at most the cohesion.",
                    basal.residual_cohesion, basal.cohesion));
  }
}

void check_times(const Case& checked, Reading& reading) {
  const Time& time = checked.time;
  if (!reading.sound({"time.end"})) {
    return;
  }
  if (time.stepping == Stepping::fixed && reading.sound({"time.step"}) && time.step > time.end) {
    reading.report("time.step",
                   fmt::format("time.step is {} s, longer than the run, time.end = {} s.", time.step, time.end));
  }
}

// Columns of the profile against the domain; empty where there is none, or it has a problem of its own.
ProfileTable checked_profile(const Case& checked, Reading& reading) {
  if (checked.terrain.kind != TerrainKind::profile || !reading.sound({"terrain.file"}) ||
      checked.terrain.file.empty()) {
    return {};
  }
  ProfileTable profile;
  try {
    profile = read_profile(checked.terrain.file);
  } catch (const UserError& error) {
    reading.report("terrain.file", fmt::format("terrain.file: {}", error.what()));
    return {};
  }
  if (!checked.terrain.extend && reading.sound({"grid.min", "grid.max"}) &&
      (profile.distance.front() > checked.grid.min[0] || profile.distance.back() < checked.grid.max[0])) {
    reading.report(
        "terrain.file",
        fmt::format("the profile reaches from {} to {} m and the domain from {} to {} m; allowed: a profile that "
                    "covers the domain. Set terrain.extend = true to continue its last gradients, or make the "
                    "domain shorter.",
                    profile.distance.front(), profile.distance.back(), checked.grid.min[0], checked.grid.max[0]));
  }
  return profile;
}

}  // namespace

void check_case(const Case& checked, Reading& reading) {
  if (reading.dimension == 0) {
    return;
  }
  check_grid(checked, reading);
  check_times(checked, reading);
  check_materials(checked, reading);
  check_basal(checked, reading);
  check_bodies(checked, checked_profile(checked, reading), reading);
}

}  // namespace thawslide::config
