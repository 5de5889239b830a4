#include "config/checks.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include "base/error.hpp"
#include "base/rounding.hpp"
#include "config/fitting_cell.hpp"

namespace thawslide::config {

namespace {

constexpr double fewest_cells = 2.0;    // of the domain along each axis
constexpr double most_intervals = 1e9;  // within the run: more are unintended and cannot be written
constexpr double most_cells = 5e5;      // limit of the tile numbers in the sparse grid
const char* const axis_names[] = {"x", "y", "z"};
const std::array side_names{"heat.boundary.x_min", "heat.boundary.x_max", "heat.boundary.y_min",
                            "heat.boundary.y_max", "heat.boundary.z_min", "heat.boundary.z_max"};

void check_grid(const Case& checked, Reading& reading) {
  const Grid& grid = checked.grid;
  if (!reading.are_valid({"grid.cell", "grid.min", "grid.max"})) {
    return;
  }
  for (std::size_t a = 0; a < static_cast<std::size_t>(checked.general.dimension); ++a) {
    const double length = grid.max[a] - grid.min[a];
    if (!(length > 0.0)) {
      reading.report_misfit({"grid.max", "grid.min"},
                            fmt::format("grid.max is {} along {}, not above grid.min, which is {}; give the domain a "
                                        "highest corner above its lowest one.",
                                        grid.max[a], axis_names[a], grid.min[a]));
      return;
    }
    const double cells = length / grid.cell;
    if (cells > most_cells) {
      reading.report_misfit({"grid.cell", "grid.max", "grid.min"},
                            fmt::format("grid.cell is {} m, and the domain is {} m long along {}: {} cells; allowed: "
                                        "at most {}. Make the cell larger or the domain smaller.",
                                        grid.cell, length, axis_names[a], count_text(cells), count_text(most_cells)));
      return;
    }
    if (cells < fewest_cells) {
      reading.report_misfit({"grid.cell", "grid.max", "grid.min"},
                            fmt::format("grid.cell is {} m, and the domain is {} m long along {}; allowed: at least "
                                        "{} cells along each axis. Make the cell smaller or the domain larger.",
                                        grid.cell, length, axis_names[a], fewest_cells));
      return;
    }
    const bool begins_at_terrain = a + 1 == static_cast<std::size_t>(checked.general.dimension) && has_terrain(checked);
    if (!begins_at_terrain && std::abs(cells - std::round(cells)) > 1e-6 * cells) {
      // A cell that fits this axis alone would be refused for another one.
      const double fitting = fitting_cell_near(grid.cell, lengths_of_domain(checked));
      reading.report_misfit({"grid.max", "grid.cell", "grid.min"},
                            fmt::format("the domain is {} m long along {}, which is {:.6g} cells of {} m; allowed: a "
                                        "whole number. {} grid.max along {} to {:.9g}.",
                                        length, axis_names[a], cells, grid.cell,
                                        fitting > 0.0 ? fmt::format("Make grid.cell {:.9g}, or move", fitting) : "Move",
                                        axis_names[a], grid.min[a] + std::round(cells) * grid.cell));
    }
  }
}

void check_residual_friction(const std::string& table, const Material& material, Reading& reading) {
  const double residual = material.residual_friction_angle;
  if (reading.are_valid({table + ".residual_friction_angle", table + ".friction_angle"}) &&
      residual > material.friction_angle) {
    reading.report_misfit(
        {table + ".residual_friction_angle", table + ".friction_angle"},
        fmt::format("{}.residual_friction_angle is {} degrees, above {}.friction_angle, which is {} degrees; softening "
                    "cannot increase friction. Give a residual at most the friction angle.",
                    table, residual, table, material.friction_angle));
  } else if (reading.are_valid({table + ".residual_friction_angle", table + ".dilation_angle"}) &&
             residual < material.dilation_angle && material.dilation_angle <= material.friction_angle) {
    reading.report_misfit(
        {table + ".residual_friction_angle", table + ".dilation_angle"},
        fmt::format("{}.residual_friction_angle is {} degrees, below {}.dilation_angle, which is {} degrees; allowed: "
                    "at least the dilation angle, which does not soften, otherwise plastic flow creates energy.",
                    table, residual, table, material.dilation_angle));
  }
}

void check_materials(const Case& checked, Reading& reading) {
  for (const auto& [name, material] : checked.materials) {
    const std::string table = "material." + name;
    if (reading.are_valid({table + ".cohesion", table + ".residual_cohesion"}) &&
        material.residual_cohesion > material.cohesion) {
      reading.report_misfit({table + ".residual_cohesion", table + ".cohesion"},
                            fmt::format("{}.residual_cohesion is {} Pa, above {}.cohesion, which is {} Pa; softening "
                                        "cannot increase cohesion. Give a residual at most the cohesion.",
                                        table, material.residual_cohesion, table, material.cohesion));
    }
    if (reading.are_valid({table + ".dilation_angle", table + ".friction_angle"}) &&
        material.dilation_angle > material.friction_angle) {
      reading.report_misfit(
          {table + ".dilation_angle", table + ".friction_angle"},
          fmt::format("{}.dilation_angle is {} degrees, above {}.friction_angle, which is {} degrees; allowed: at most "
                      "the friction angle, otherwise plastic flow creates energy.",
                      table, material.dilation_angle, table, material.friction_angle));
    }
    check_residual_friction(table, material, reading);
  }
}

void check_filter(const Case& checked, Reading& reading) {
  const Mechanics& mechanics = checked.mechanics;
  if (!reading.are_valid({"mechanics.transfer", "mechanics.fmpm_order", "mechanics.fmpm_interval"})) {
    return;
  }
  if (mechanics.transfer != Transfer::fmpm) {
    const Mechanics usual;
    for (const auto& [key, is_given] :
         {std::pair("mechanics.fmpm_interval", mechanics.fmpm_interval != usual.fmpm_interval),
          std::pair("mechanics.fmpm_order", mechanics.fmpm_order != usual.fmpm_order)}) {
      if (is_given) {
        reading.report_misfit({key, "mechanics.transfer"},
                              fmt::format("{} is given, and mechanics.transfer is not \"fmpm\"; no other transfer has "
                                          "it. Set mechanics.transfer = \"fmpm\", or remove {}.",
                                          key, key));
      }
    }
  } else if (checked.time.stepping == Stepping::fixed && reading.are_valid({"time.step"}) &&
             mechanics.fmpm_interval < checked.time.step) {
    reading.report_misfit({"mechanics.fmpm_interval", "time.step"},
                          fmt::format("mechanics.fmpm_interval is {} s, shorter than time.step, which is {} s; "
                                      "velocities are filtered once a step at most. Make the interval longer.",
                                      mechanics.fmpm_interval, checked.time.step));
  }
}

// Checks keys that make each other ineffective.
void check_switches(const Case& checked, Reading& reading) {
  const bool has_ground = checked.terrain.kind != TerrainKind::none;
  if (reading.are_valid({"mechanics.enabled", "heat.enabled", "pressure.enabled"}) && !checked.mechanics.enabled &&
      !checked.heat.enabled && !checked.pressure.enabled) {
    reading.report_misfit(
        {"mechanics.enabled", "heat.enabled", "pressure.enabled"},
        "mechanics.enabled, heat.enabled and pressure.enabled are all false: nothing is left to compute. Set "
        "at least one of them to true.");
  }
  if (reading.are_valid({"mechanics.slope_shear", "mechanics.initial_stress"}) && checked.mechanics.slope_shear &&
      checked.mechanics.initial_stress != InitialStress::geostatic) {
    reading.report_misfit(
        {"mechanics.slope_shear", "mechanics.initial_stress"},
        "mechanics.slope_shear is true, and mechanics.initial_stress is not \"geostatic\"; only that stress "
        "takes the shear. Set mechanics.initial_stress = \"geostatic\", or mechanics.slope_shear = false.");
  }
  if (reading.are_valid({"mechanics.pic_fraction", "mechanics.transfer"}) && checked.mechanics.pic_fraction != 0.0 &&
      checked.mechanics.transfer != Transfer::blend) {
    reading.report_misfit(
        {"mechanics.pic_fraction", "mechanics.transfer"},
        fmt::format(
            "mechanics.pic_fraction is {}, and mechanics.transfer is not \"blend\"; no other transfer has it. Set "
            "mechanics.transfer = \"blend\", or remove mechanics.pic_fraction.",
            checked.mechanics.pic_fraction));
  }
  if (reading.are_valid({"band.region", "terrain.type"}) && checked.band.region == BandRegion::first_layer &&
      !has_ground) {
    reading.report_misfit(
        {"band.region", "terrain.type"},
        "band.region is \"first_layer\", and the case has no terrain; there is no layer above it. Set "
        "band.region = \"all\", or give terrain.type.");
  }
  if (reading.are_valid({"mechanics.split_stretched", "terrain.type"}) && checked.mechanics.split_stretched &&
      !has_ground) {
    reading.report_misfit(
        {"mechanics.split_stretched", "terrain.type"},
        "mechanics.split_stretched is true, and the case has no terrain; particles are stretched along it. Set "
        "mechanics.split_stretched = false, or give terrain.type.");
  }
  if (reading.are_valid({"mechanics.effective_stress", "pressure.enabled"}) && checked.mechanics.effective_stress &&
      !checked.pressure.enabled) {
    reading.report_misfit({"mechanics.effective_stress", "pressure.enabled"},
                          "mechanics.effective_stress is true, and pressure.enabled is false; there is no pore "
                          "pressure to subtract. Set pressure.enabled = true, or mechanics.effective_stress = false.");
  }
  if (reading.are_valid({"terrain.slope", "terrain.type"}) && checked.terrain.slope != 0.0 &&
      checked.terrain.kind != TerrainKind::plane) {
    reading.report_misfit(
        {"terrain.slope", "terrain.type"},
        fmt::format("terrain.slope is {} degrees, and terrain.type is not \"plane\"; no other ground has "
                    "it. Set terrain.type = \"plane\", or remove terrain.slope.",
                    checked.terrain.slope));
  }
}

// With band columns, particle temperature and pore pressure stay constant, so keys that act on them have no effect.
// Columns lack the formulations that create heat or water spuriously.
void check_band_columns(const Case& checked, Reading& reading) {
  if (!reading.are_valid({"band.model"}) || !has_band_columns(checked)) {
    return;
  }
  const auto require = [&](bool met, const char* key, const char* found, const char* allowed) {
    if (reading.are_valid({key}) && !met) {
      reading.report_misfit({key, "band.model"},
                            fmt::format("band.model is \"columns\", and {} is {}; allowed with it: {}. Set {} so, or "
                                        "band.model = \"scaled\".",
                                        key, found, allowed, key));
    }
  };
  require(checked.terrain.kind != TerrainKind::none, "terrain.type", "\"none\"", "any terrain");
  require(checked.band.thickness.is_given(), "band.thickness", "not given", "a thickness in m, constant or over time");
  require(checked.mechanics.enabled, "mechanics.enabled", "false", "true");
  require(!checked.mechanics.effective_stress, "mechanics.effective_stress", "true", "false");
  require(checked.heat.enabled, "heat.enabled", "false", "true");
  require(checked.heat.advection, "heat.advection", "false", "true");
  require(checked.heat.advection_form == AdvectionForm::conservative, "heat.advection_form", "\"as_published\"",
          "\"conservative\"");
  require(checked.pressure.clapeyron == ClapeyronSign::usual, "pressure.clapeyron", "\"published\"", "\"usual\"");
  require(!checked.pressure.volumetric_term, "pressure.volumetric_term", "true", "false");
  require(checked.pressure.seepage_scaling == SeepageScaling::consistent, "pressure.seepage_scaling", "\"published\"",
          "\"consistent\"");
  require(checked.pressure.frozen == FrozenPressure::none, "pressure.frozen", "\"ice_pressure\"", "\"none\"");
  require(checked.pressure.frozen_rows != FrozenRows::draining, "pressure.frozen_rows", "\"draining\"",
          "\"sealed\" or \"vented\"");
  require(checked.pressure.melt_contraction, "pressure.melt_contraction", "false", "true");
  require(checked.band.thickness_change == ThicknessChange::conserving, "band.thickness_change", "\"as_published\"",
          "\"conserving\"");
  for (std::size_t side = 0; side < side_names.size(); ++side) {
    require(checked.heat.boundary[side].kind == HeatBoundaryKind::insulated, side_names[side], "not \"insulated\"",
            "\"insulated\"");
  }
}

// The same for heat and water in the band.
void check_band_switches(const Case& checked, Reading& reading) {
  if (reading.are_valid({"heat.advection_form", "heat.update", "heat.masses"}) &&
      checked.heat.advection_form == AdvectionForm::conservative && water_seeps(checked) &&
      (checked.heat.update != HeatUpdate::enthalpy || checked.heat.masses != HeatMasses::initial)) {
    reading.report_misfit(
        {"heat.advection_form", "heat.update", "heat.masses"},
        "heat.advection_form is \"conservative\", and heat.update or heat.masses is as published, which still creates "
        "heat; allowed with it: heat.update = \"enthalpy\" and heat.masses = \"initial\". Set both so, or "
        "heat.advection_form = \"as_published\".");
  }
  if (reading.are_valid({"pressure.residual_stress", "pressure.frozen"}) &&
      checked.pressure.residual_stress < std::numeric_limits<double>::infinity() &&
      checked.pressure.frozen != FrozenPressure::none) {
    reading.report_misfit(
        {"pressure.residual_stress", "pressure.frozen"},
        fmt::format("pressure.residual_stress is {} Pa, and pressure.frozen is not \"none\"; if ice has a pressure, "
                    "water starts from it. Set pressure.frozen = \"none\", or remove pressure.residual_stress.",
                    checked.pressure.residual_stress));
  }
}

void check_times(const Case& checked, Reading& reading) {
  const Time& time = checked.time;
  if (!reading.are_valid({"time.end"})) {
    return;
  }
  if (time.stepping == Stepping::fixed && reading.are_valid({"time.step"}) && time.step > time.end) {
    reading.report_misfit(
        {"time.step", "time.end"},
        fmt::format("time.step is {} s, longer than the run, which ends at time.end = {} s; allowed: at "
                    "most that. Make the step smaller, or the run longer.",
                    time.step, time.end));
  }
  const std::initializer_list<std::tuple<std::string, double, const char*>> intervals{
      {"time.output_interval", time.output_interval, ""},
      {"time.history_interval", time.history_interval, "; 0: a row every step"},
      {"checkpoint.interval", checked.checkpoint.interval, "; 0: none by simulated time"}};
  for (const auto& [key, interval, or_none] : intervals) {
    if (reading.are_valid({key}) && interval > 0.0 && interval < time.end / most_intervals) {
      const bool is_given = reading.is_given(key);
      reading.report_misfit({is_given ? key : "time.end", is_given ? "time.end" : key},
                            fmt::format("{} is {} s, and the run of {} s has {} times as much; allowed: {:.4g} s and "
                                        "more, {} of them in the run{}. Make it longer, or the run shorter.",
                                        key, interval, time.end, rounded_text(time.end / interval, 2),
                                        rounded_up(time.end / most_intervals, 4), count_text(most_intervals), or_none));
    }
  }
}

// Checks the profile against the domain; returns an empty table if there is none, or if it has other problems.
ProfileTable checked_profile(const Case& checked, Reading& reading) {
  if (checked.terrain.kind != TerrainKind::profile || !reading.are_valid({"terrain.file"}) ||
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
  if (!checked.terrain.extend && reading.are_valid({"grid.min", "grid.max"}) &&
      (profile.distance.front() > checked.grid.min[0] || profile.distance.back() < checked.grid.max[0])) {
    reading.report_misfit(
        {"terrain.file", "grid.max", "grid.min", "terrain.extend"},
        fmt::format("the profile reaches from {} to {} m and the domain from {} to {} m; allowed: a profile that "
                    "covers the domain. Set terrain.extend = true to continue its last gradients, or make the "
                    "domain shorter.",
                    profile.distance.front(), profile.distance.back(), checked.grid.min[0], checked.grid.max[0]));
  }
  return profile;
}

}  // namespace

void check_material(const Case& checked, const std::string& table, const std::string& name, Reading& reading) {
  std::vector<std::string> known;
  for (const auto& [material, unused] : checked.materials) {
    known.push_back(material);
  }
  if (reading.are_valid({table + ".material"}) && checked.materials.count(name) == 0) {
    const std::string hint = did_you_mean(name, known);
    reading.report(table + ".material",
                   fmt::format("{}.material is '{}', and there is no [material.{}]{} Allowed: {}.", table, name, name,
                               hint.empty() ? "." : hint,
                               known.empty() ? "none, as the case has no [material.NAME]" : comma_list(known)));
  }
}

void check_case(const Case& checked, Reading& reading) {
  if (reading.dimension == 0) {
    return;
  }
  check_grid(checked, reading);
  check_cells(checked, reading);
  check_times(checked, reading);
  check_materials(checked, reading);
  check_grounds(checked, reading);
  check_bed(checked, reading);
  check_contact(checked, reading);
  check_switches(checked, reading);
  check_band_switches(checked, reading);
  check_band_columns(checked, reading);
  check_filter(checked, reading);
  check_bodies(checked, checked_profile(checked, reading), reading);
  check_maps(checked, reading);
  check_files(checked, reading);
  check_width(checked, reading);
}

}  // namespace thawslide::config
