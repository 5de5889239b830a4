// Values that are valid but probably unintended.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/rounding.hpp"
#include "config/grounds.hpp"
#include "config/notices.hpp"
#include "physics/basal/laws.hpp"

namespace thawslide::config {

namespace {

constexpr double smallest_angle = 3.0;            // [degrees]; tan 3 is 0.05, the minimum reported for ice on ice
constexpr double least_strain_at_failure = 3e-6;  // cohesion over Young's modulus; crushed ice has about 5e-6
constexpr double largest_coefficient = 1.5;
constexpr double steepest_widening = 1.0;  // [m/m]; 27 degrees per side
constexpr double warm = 0.0;               // [C]

class Warnings {
 public:
  explicit Warnings(const Case& parameters) : case_(parameters) {}
  // Adds a warning about a key [dotted]; `text` follows its value.
  template <class Value>
  void add(const std::string& key, const Value& value, const std::string& unit, const std::string& text) {
    found_.push_back(fmt::format("{}: {} is {}{}: {}", location_of(case_, key), key, value, unit, text));
  }
  // Adds a warning without a key.
  void add(std::string text) { found_.push_back(std::move(text)); }
  [[nodiscard]] std::vector<std::string> release() { return std::move(found_); }

 private:
  const Case& case_;
  std::vector<std::string> found_;
};

// Lateral motion of a widening section has b'^2/12 of the kinetic energy, which is neglected here.
void warn_about_width(const Case& parameters, Warnings& warnings) {
  const Table& width = parameters.general.width.table;
  for (std::size_t k = 1; k < width.abscissa.size(); ++k) {
    const double slope = (width.value[k] - width.value[k - 1]) / (width.abscissa[k] - width.abscissa[k - 1]);
    if (std::abs(slope) > steepest_widening) {
      warnings.add("case.width",
                   fmt::format("{:g} m at x = {:.9g} m and {:g} m at x = {:.9g} m", width.value[k - 1],
                               width.abscissa[k - 1], width.value[k], width.abscissa[k]),
                   "",
                   fmt::format("it changes by {} m per m. The neglected lateral motion would have {:.2g} of the "
                               "kinetic energy there. Spread the change of width over a longer distance.",
                               rounded_text(std::abs(slope), 2), slope * slope / 12.0));
      return;
    }
  }
}

void warn_about_materials(const Case& parameters, Warnings& warnings) {
  const bool deforms = parameters.mechanics.enabled && parameters.mechanisms.deformation;
  const bool is_pressed = has_pore_water(parameters) && parameters.mechanisms.pressurization &&
                          parameters.pressure.seepage && parameters.band.thickness.is_given();
  for (const auto& [name, material] : parameters.materials) {
    const std::string table = "material." + name + ".";
    if (deforms && material.youngs_modulus < softest_modulus) {
      warnings.add(table + "youngs_modulus", material.youngs_modulus, " Pa",
                   "too soft: the slide collapses under its own weight. Typical values for broken rock and ice are 1e7 "
                   "Pa or more.");
    }
    if (deforms && material.law == LawKind::mohr_coulomb && material.friction_angle > 0.0 &&
        material.friction_angle < smallest_angle) {
      warnings.add(table + "friction_angle", material.friction_angle, " degrees",
                   "was a coefficient meant? Angles are in degrees; 35 is a coefficient of 0.7.");
    }
    const double least_cohesion = least_strain_at_failure * material.youngs_modulus;
    if (deforms && material.law == LawKind::mohr_coulomb && material.cohesion > 0.0 &&
        material.cohesion < least_cohesion) {
      warnings.add(
          table + "cohesion", material.cohesion, " Pa",
          fmt::format("very weak for a material of this youngs_modulus: {:.2g} Pa or more, or 0, is plausible. "
                      "If it is in kPa, it is {:g} Pa.",
                      least_cohesion, 1e3 * material.cohesion));
    }
    const std::string conductivity = table + "hydraulic_conductivity";
    if (is_pressed && material.hydraulic_conductivity == 0.0 && !was_given(parameters, conductivity)) {
      warnings.add(conductivity, material.hydraulic_conductivity, " m/s, its default",
                   "pore water cannot drain, and the avalanche may never stop. Typical values at the base are 1e-8 to "
                   "1e-5 m/s. Set a value, or set 0 explicitly to silence this warning.");
    }
  }
}

void warn_about_band(const Case& parameters, Warnings& warnings) {
  const bool has_basal_friction = parameters.mechanics.enabled && parameters.terrain.kind != TerrainKind::none;
  const bool has_effect = parameters.heat.enabled && parameters.basal.heat_fraction > 0.0 &&
                          (parameters.mechanisms.lubrication || parameters.mechanisms.pressurization);
  if (has_basal_friction && has_effect && !parameters.band.thickness.is_given()) {
    warnings.add(fmt::format(
        "{}: band.thickness is not given: friction then heats the lowest cells as a whole, {:g} m thick, which barely "
        "warm or melt. Set the thickness of the shear band: typical values are 0.01 to 2 m. Without melting, set "
        "heat.enabled = false.",
        parameters.file, parameters.grid.cell));
  }
}

// True if the friction law of a keyword uses a parameter.
bool uses(const std::string& law, const physics::basal::Parameter& number) {
  bool found = false;
  physics::basal::for_each_law<physics::basal::FrictionLaw>([&]<class Law>(physics::basal::OfType<Law>) {
    found = found || (law == Law::keyword &&
                      std::find(Law::parameters.begin(), Law::parameters.end(), &number) != Law::parameters.end());
  });
  return found;
}

void warn_about_ground(const std::string& table, const GroundStrength& ground, Warnings& warnings) {
  const double coefficient = ground.numbers(physics::basal::friction_coefficient);
  if (uses(ground.friction, physics::basal::friction_coefficient) && coefficient > largest_coefficient) {
    warnings.add(table + ".friction_coefficient", coefficient, "",
                 "was an angle in degrees meant? A coefficient is its tangent: 25 degrees are 0.466.");
  }
  const double angle = ground.numbers(physics::basal::friction_angle);
  if (uses(ground.friction, physics::basal::friction_angle) && angle > 0.0 && angle < smallest_angle) {
    warnings.add(table + ".friction_angle", angle, " degrees",
                 "was a coefficient meant? Angles are in degrees; for a coefficient set friction = \"coefficient\" and "
                 "friction_coefficient.");
  }
}

void warn_about_gaps(const Case& parameters, Warnings& warnings) {
  const std::vector<Strip> strips = strips_of(parameters);
  for (std::size_t k = 1; k < strips.size(); ++k) {
    if (const double from = strips[k - 1].to, to = strips[k].from; to > from) {
      warnings.add(fmt::format(
          "between the substrates {} and {}, from x = {:.9g} to {:.9g} m, there is no substrate: [basal] applies there",
          strips[k - 1].name, strips[k].name, from, to));
    }
  }
}

void warn_about_bed(const Case& parameters, Warnings& warnings) {
  const Bed& bed = parameters.bed;
  if (bed.law == BedLaw::none) {
    return;
  }
  if (bed.friction_angle > 0.0 && bed.friction_angle < smallest_angle) {
    warnings.add("bed.friction_angle", bed.friction_angle, " degrees",
                 "was a coefficient meant? Angles are in degrees; 6 is a coefficient of 0.1.");
  }
  if (bed.temperature > parameters.freezing.reference_temperature) {
    warnings.add("bed.temperature", bed.temperature, " C",
                 "the bed's pores contain water and no ice. Was a temperature below 0 meant?");
  }
}

void warn_about_bodies(const Case& parameters, Warnings& warnings) {
  for (const auto& [name, body] : parameters.bodies) {
    const auto& temperatures = body.temperature.table.value;
    const double warmest = temperatures.empty() ? warm : *std::max_element(temperatures.begin(), temperatures.end());
    if (parameters.terrain.kind != TerrainKind::none && !body.saturation.is_given() &&
        warmest > parameters.freezing.reference_temperature) {
      warnings.add("body." + name + ".temperature", warmest, " C",
                   "its pores contain water and no ice from the start. Was a temperature below 0 meant?");
    }
  }
}

void warn_about_output(const Case& parameters, Warnings& warnings) {
  const Time& time = parameters.time;
  const struct {
    const char* key;
    double interval;
    const char* rest;
  } intervals[] = {{"time.output_interval", time.output_interval, "only the first and the last snapshot"},
                   {"time.history_interval", time.history_interval, "only the first and the last row of history.csv"},
                   {"checkpoint.interval", parameters.checkpoint.interval, "the checkpoints by wall-clock time"}};
  for (const auto& [key, interval, rest] : intervals) {
    if (interval > time.end) {
      warnings.add(key, interval, " s", fmt::format("longer than the run of {} s, which leaves {}.", time.end, rest));
    }
  }
  // A short trial of a case that stops at rest: the command line sets the end, but no key of rest.
  const auto is_set = [&](const char* key) { return location_of(parameters, key).starts_with("--"); };
  const bool is_trial = is_set("time.end") && !is_set("time.stop_at_rest") && !is_set("time.rest_time");
  if (time.stop_at_rest > 0.0 && time.rest_time > time.end && !is_trial) {
    warnings.add("time.rest_time", time.rest_time, " s",
                 fmt::format("longer than the run of {} s, which then never stops at rest.", time.end));
  }
}

}  // namespace

std::vector<std::string> implausible(const Case& parameters) {
  Warnings warnings(parameters);
  warn_about_width(parameters, warnings);
  warn_about_materials(parameters, warnings);
  warn_about_band(parameters, warnings);
  warn_about_ground("basal", parameters.basal, warnings);
  for (const auto& [name, substrate] : parameters.substrates) {
    warn_about_ground("substrate." + name, substrate, warnings);
  }
  warn_about_bed(parameters, warnings);
  warn_about_bodies(parameters, warnings);
  warn_about_output(parameters, warnings);
  warn_about_gaps(parameters, warnings);
  return warnings.release();
}

}  // namespace thawslide::config
