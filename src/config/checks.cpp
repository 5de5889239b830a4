#include "config/checks.hpp"

#include <tuple>

#include "base/error.hpp"
#include "base/rounding.hpp"

namespace thawslide::config {

namespace {

constexpr double most_intervals = 1e9;  // within the run: more are unintended and cannot be written
constexpr double fewest_cells = 2.0;    // of the domain along each axis
constexpr double most_cells = 5e5;      // limit of the tile numbers in the sparse grid

void check_grid(const Case& checked, Reading& reading) {
  const Grid& grid = checked.grid;
  if (!reading.are_valid({"grid.cell", "grid.min", "grid.max"})) {
    return;
  }
  for (std::size_t a = 0; a < static_cast<std::size_t>(checked.general.dimension); ++a) {
    const double length = grid.max[a] - grid.min[a];
    const double cells = length / grid.cell;
    reading.refuse_if(
        !(length > 0.0), {"grid.max", "grid.min"},
        "grid.max is {} along {}, not above grid.min, which is {}; give the domain a highest corner above "
        "its lowest one.",
        grid.max[a], axis_names[a], grid.min[a]);
    reading.refuse_if(
        cells > most_cells, {"grid.cell", "grid.max", "grid.min"},
        "grid.cell is {} m, and the domain is {} m long along {}: {} cells; allowed: at most {}. Make the "
        "cell larger or the domain smaller.",
        grid.cell, length, axis_names[a], count_text(cells), count_text(most_cells));
    reading.refuse_if(cells < fewest_cells, {"grid.cell", "grid.max", "grid.min"},
                      "grid.cell is {} m, and the domain is {} m long along {}; allowed: at least {} cells along each "
                      "axis. Make the cell smaller or the domain larger.",
                      grid.cell, length, axis_names[a], fewest_cells);
  }
}

void check_materials(const Case& checked, Reading& reading) {
  for (const auto& [name, material] : checked.materials) {
    const std::string table = "material." + name, friction = table + ".friction_angle",
                      dilation = table + ".dilation_angle", residual = table + ".residual_friction_angle";
    reading.refuse_if(material.residual_cohesion > material.cohesion,
                      {table + ".residual_cohesion", table + ".cohesion"},
                      "{0}.residual_cohesion is {1} Pa, above {0}.cohesion, which is {2} Pa; softening cannot increase "
                      "cohesion. Give a residual at most the cohesion.",
                      table, material.residual_cohesion, material.cohesion);
    reading.refuse_if(material.dilation_angle > material.friction_angle, {dilation, friction},
                      "{0}.dilation_angle is {1} degrees, above {0}.friction_angle, which is {2} degrees; allowed: at "
                      "most the friction angle, otherwise plastic flow creates energy.",
                      table, material.dilation_angle, material.friction_angle);
    reading.refuse_if(material.residual_friction_angle > material.friction_angle, {residual, friction},
                      "{0}.residual_friction_angle is {1} degrees, above {0}.friction_angle, which is {2} degrees; "
                      "softening cannot increase friction. Give a residual at most the friction angle.",
                      table, material.residual_friction_angle, material.friction_angle);
    reading.refuse_if(material.residual_friction_angle < material.dilation_angle &&
                          material.dilation_angle <= material.friction_angle,
                      {residual, dilation},
                      "{0}.residual_friction_angle is {1} degrees, below {0}.dilation_angle, which is {2} degrees; "
                      "allowed: at least the dilation angle, which does not soften, otherwise plastic flow creates "
                      "energy.",
                      table, material.residual_friction_angle, material.dilation_angle);
  }
}

void check_times(const Case& checked, Reading& reading) {
  const Time& time = checked.time;
  if (!reading.are_valid({"time.end"})) {
    return;
  }
  reading.refuse_if(
      time.stepping == Stepping::fixed && time.step > time.end, {"time.step", "time.end"},
      "time.step is {} s, longer than the run, which ends at time.end = {} s; allowed: at most that. Make "
      "the step smaller, or the run longer.",
      time.step, time.end);
  const std::initializer_list<std::tuple<std::string, double, const char*>> intervals{
      {"time.output_interval", time.output_interval, ""},
      {"time.history_interval", time.history_interval, "; 0: a row every step"},
      {"checkpoint.interval", checked.checkpoint.interval, "; 0: none by simulated time"}};
  for (const auto& [key, interval, or_none] : intervals) {
    if (reading.are_valid({key}) && interval > 0.0 && interval < time.end / most_intervals) {
      const bool is_given = reading.is_given(key);
      reading.report({is_given ? key : "time.end", is_given ? "time.end" : key},
                     "{} is {} s, and the run of {} s has {} times as much; allowed: {:.4g} s and "
                     "more, {} of them in the run{}. Make it longer, or the run shorter.",
                     key, interval, time.end, rounded_text(time.end / interval, 2),
                     rounded_up(time.end / most_intervals, 4), count_text(most_intervals), or_none);
    }
  }
}

void check_force_periods(const Case& checked, Reading& reading) {
  const Report& report = checked.report;
  reading.refuse_if(!report.force_record.empty() && report.force_periods.size() != 2, {"report.force_periods"},
                    "report.force_periods is an array of {} numbers; allowed: 2 numbers, the shortest and the longest "
                    "period of the waves.",
                    report.force_periods.size());
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
    reading.report({"terrain.file"}, "terrain.file: {}", error.what());
    return {};
  }
  const double from = profile.distance.front(), to = profile.distance.back();
  if (!checked.terrain.extend && reading.are_valid({"grid.min", "grid.max"}) &&
      (from > checked.grid.min[0] || to < checked.grid.max[0])) {
    reading.report({"terrain.file", "grid.max", "grid.min", "terrain.extend"},
                   "the profile reaches from {} to {} m and the domain from {} to {} m; allowed: a profile that covers "
                   "the domain. Set terrain.extend = true to continue its last gradients, or make the domain shorter.",
                   from, to, checked.grid.min[0], checked.grid.max[0]);
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
    reading.report({table + ".material"}, "{}.material is '{}', and there is no [material.{}]{} Allowed: {}.", table,
                   name, name, did_you_mean(name, known, "."),
                   known.empty() ? "none, as the case has no [material.NAME]" : comma_list(known));
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
  check_exclusions(checked, reading);
  check_bodies(checked, checked_profile(checked, reading), reading);
  check_maps(checked, reading);
  check_force_periods(checked, reading);
  check_width(checked, reading);
}

}  // namespace thawslide::config
