#include "config/notices.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "base/portability.hpp"
#include "config/declaration.hpp"

namespace thawslide::config {

namespace {

// Magnitudes of plausible numbers, unless 0, by unit or key; outside, another unit is probable. Without a range:
// coordinates and lengths of the domain, intervals of output, keys of plausibility.cpp, and keys whose allowed range
// excludes others.
struct Plausible {
  std::string_view name;
  double low, high;
};
// clang-format off
constexpr Plausible plausible[] = {
    {"Pa", 300, 1e8}, {"1/Pa", 1e-12, 1e-6}, {"degrees", 1.6, 90}, {"J/kg/K", 200, 5000}, {"W/m/K", 0.1, 20},
    {"1/K", 1e-6, 5e-3}, {"J/kg", 1e5, 1e6}, {"N/m3", 5e3, 2e4}, {"1/s", 1e-3, 50}, {"m/s", 1e-3, 120},
    {"case.gravity", 9.5, 10.1}, {"time.step", 0, 0.5}, {"time.stop_at_rest", 1e-4, 2},
    {"terrain.elevation", 1e-3, 9000}, {"checkpoint.wall_interval", 0, 1e5}, {"maps.arrival_thickness", 1e-4, 5},
    {"report.force_periods", 0.05, 1000}, {"phases.rock_density", 2000, 3600}, {"phases.ice_density", 800, 950},
    {"phases.water_density", 950, 1300}, {"phases.water_bulk_modulus", 1e7, 1e10}, {"freezing.slope", 0, 1e300},
    {"freezing.reference_temperature", 1e-3, 10}, {"material.youngs_modulus", 0, 1e11},
    {"material.friction_angle", 0, 90}, {"material.dilation_angle", 0.5, 45}, {"material.softening_slip", 1e-4, 50},
    {"material.viscosity_time", 1e-6, 1}, {"material.hydraulic_conductivity", 1e-14, 1e-3},
    {"body.thickness", 0.02, 500}, {"body.taper", 0.02, 1000}, {"body.surface_tolerance", 1e-6, 2},
    {"body.porosity", 0.02, 0.9}, {"mechanics.fmpm_interval", 1e-6, 1}, {"mechanics.settle_time", 0.05, 600},
    {"basal.friction_angle", 0, 90}, {"basal.turbulent_friction", 100, 1e4}, {"basal.slip_distance", 0.01, 1000},
    {"basal.cohesion_loss_time", 1e-3, 1e4}, {"bed.depth", 0.01, 200}, {"bed.strength", 50, 1e7},
    {"bed.friction_angle", 0, 90}, {"band.thickness", 1e-4, 20}, {"band.grain_size", 1e-5, 5},
    {"band.mixing_slip", 1e-3, 1e4}, {"band.load_time", 1e-3, 60}, {"band.column_step", 1e-5, 2}};

// Other units in which a number is often given, and the number of the case's unit that each equals.
struct OtherUnit {
  std::string_view unit, other;
  double factor;
};
constexpr OtherUnit other_units[] = {
    {"Pa", "kPa", 1e3}, {"Pa", "MPa", 1e6}, {"Pa", "GPa", 1e9}, {"1/Pa", "1/kPa", 1e-3}, {"1/Pa", "1/MPa", 1e-6},
    {"1/Pa", "1/GPa", 1e-9}, {"m", "mm", 1e-3}, {"m", "cm", 1e-2}, {"m", "km", 1e3}, {"m", "ft", 0.3048},
    {"s", "ms", 1e-3}, {"s", "min", 60}, {"s", "h", 3600}, {"m/s", "mm/s", 1e-3}, {"m/s", "cm/s", 1e-2},
    {"m/s", "km/h", 1 / 3.6}, {"m/s", "m/h", 1 / 3600.0}, {"m/s", "m/day", 1 / 86400.0}, {"m/s2", "ft/s2", 0.3048},
    {"degrees", "radians", 180 / pi}, {"W/m/K", "mW/m/K", 1e-3}, {"W/m/K", "W/cm/K", 100}, {"J/kg/K", "kJ/kg/K", 1e3},
    {"J/kg/K", "kcal/kg/K", 4186.8}, {"J/kg", "kJ/kg", 1e3}, {"J/kg", "kcal/kg", 4186.8}, {"J/kg", "J/m3", 1 / 917.0},
    {"N/m3", "kN/m3", 1e3}, {"kg/m3", "g/cm3", 1e3}, {"1/K", "1e-6/K", 1e-6}, {"1/s", "1/min", 1 / 60.0},
    {"1/s", "1/h", 1 / 3600.0}};
// clang-format on

// Text about the units in which a number would be plausible; empty if there are none.
std::string probable_units(double number, const Rule& rule, const Plausible& range) {
  std::string text;
  for (const auto& [unit, other, factor] : other_units) {
    const double converted = number * factor;
    if (rule.unit == unit && std::abs(converted) >= range.low && std::abs(converted) <= range.high) {
      text +=
          fmt::format("{} {}, it is {:.4g} {}", text.empty() ? " If it is in" : "; in", other, converted, rule.unit);
    }
  }
  return text.empty() ? "" : text + ".";
}

// Range of a key or of its unit; [substrate.NAME] has those of [basal].
const Plausible* range_of(const std::string& table, const Rule& rule) {
  const std::string key = (table == "substrate" ? "basal" : table) + "." + rule.key;
  const Plausible* of_unit = nullptr;
  for (const Plausible& each : plausible) {
    if (each.name == key) {
      return &each;
    }
    of_unit = each.name == rule.unit ? &each : of_unit;
  }
  return of_unit;
}

std::string notice(const Case& parameters, const std::string& table, const KeyNumbers& of) {
  const Rule& rule = *of.rule;
  const std::string unit = rule.unit.empty() ? "" : " " + rule.unit;
  const std::string start = fmt::format("{}: {} is ", location_of(parameters, of.key), of.key);
  // Conduction alone has time steps and porosities of any size.
  const bool has_range =
      was_given(parameters, of.key) && (parameters.mechanics.enabled || (rule.unit != "s" && !rule.unit.empty()));
  if (const Plausible* range = range_of(table, rule); range != nullptr && has_range) {
    for (const double number : of.numbers) {
      const double size = std::abs(number);
      if (std::isfinite(number) && size > 0.0 && (size < range->low || size > range->high)) {
        return fmt::format("{}{:g}{}; plausible: {:g} to {:g}{}.{}", start, number, unit, range->low, range->high, unit,
                           probable_units(number, rule, *range));
      }
    }
  }
  for (const double number : of.numbers) {
    if (of.is_usual && !rule.usual.contains(number)) {
      return fmt::format("{}{:g}{}, outside the usual {}", start, number, unit, rule.usual.text(rule.unit));
    }
  }
  return "";
}

}  // namespace

std::vector<std::string> unusual_numbers(const Case& parameters) {
  std::vector<std::string> found;
  for (const auto& table : tables()) {
    std::vector<KeyNumbers> keys;
    table->collect_numbers(parameters, keys);
    for (const KeyNumbers& each : keys) {
      if (std::string text = notice(parameters, table->name, each); !text.empty()) {
        found.push_back(std::move(text));
      }
    }
  }
  return found;
}

std::vector<std::string> notices(const Case& parameters) {
  std::vector<std::string> notices = parameters.notes;
  for (const auto& more : {unusual_numbers(parameters), implausible(parameters)}) {
    notices.insert(notices.end(), more.begin(), more.end());
  }
  return notices;
}

}  // namespace thawslide::config
