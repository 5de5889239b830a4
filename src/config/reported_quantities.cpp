#include "config/reported_quantities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>
#include <utility>

namespace thawslide::config {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double absolute_zero = -273.15;                       // C
constexpr double shortest_period = 1e-3, longest_period = 1e5;  // s
constexpr double degrees_per_radian = 57.29577951308232;

// Number of digits with an optional decimal point between them, and nothing else.
std::optional<double> plain_decimal(const std::string& text) {
  constexpr const char* digits = "0123456789";
  const std::size_t point = text.find('.');
  const auto is_whole = [&](const std::string& part) {
    return !part.empty() && part.find_first_not_of(digits) == std::string::npos;
  };
  if (!is_whole(text.substr(0, point)) || (point != std::string::npos && !is_whole(text.substr(point + 1)))) {
    return std::nullopt;
  }
  double value = infinity;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

// Periods [s] in NAME_35_150_s, a force between periods.
std::optional<std::pair<double, double>> periods_of(const std::string& name) {
  const std::string prefix = std::string(reported_force) + "_", suffix = "_s";
  if (name.size() <= prefix.size() + suffix.size() || name.compare(0, prefix.size(), prefix) != 0 ||
      name.compare(name.size() - suffix.size(), suffix.size(), suffix) != 0) {
    return std::nullopt;
  }
  const std::string between = name.substr(prefix.size(), name.size() - prefix.size() - suffix.size());
  const std::size_t parting = between.find('_');
  if (parting == std::string::npos) {
    return std::nullopt;
  }
  const auto shortest = plain_decimal(between.substr(0, parting)), longest = plain_decimal(between.substr(parting + 1));
  return shortest && longest ? std::optional(std::pair(*shortest, *longest)) : std::nullopt;
}

}  // namespace

const std::vector<ReportedQuantity>& reported_quantities() {
  static const std::vector<ReportedUnit> length{{"m"}, {"km", 1e3}, {"cm", 1e-2}}, speed{{"m/s"}, {"km/h", 1.0 / 3.6}},
      temperature{{"C"}, {"degC"}, {"°C"}, {"K", 1.0, absolute_zero}},
      force{{"N"}, {"kN", 1e3}, {"MN", 1e6}, {"GN", 1e9}, {"TN", 1e12}},
      pressure{{"Pa"}, {"kPa", 1e3}, {"MPa", 1e6}, {"GPa", 1e9}},
      area{{"m2"}, {"m²"}, {"ha", 1e4}, {"km2", 1e6}, {"km²", 1e6}},
      volume{{"m3"}, {"m³"}, {"million m3", 1e6}, {"million m³", 1e6}, {"km3", 1e9}, {"km³", 1e9}},
      angle{{"degrees"}, {"deg"}, {"°"}, {"rad", degrees_per_radian}}, fraction{{"-"}, {"1"}, {""}, {"%", 1e-2}};
  static const std::vector<ReportedQuantity> all{
      {sets_clock, &speed, 0.0, infinity, false},
      {"mean_velocity", &speed, 0.0, infinity, true},
      {"mean_displacement", &length, 0.0, infinity, true},
      {"front_distance", &length, 0.0, infinity, true},
      {"band_SL", &fraction, 0.0, 1.0, true},
      {"band_saturation", &fraction, 0.0, 1.0, true},
      {"band_temperature", &temperature, absolute_zero, infinity, true},
      {"band_pore_pressure", &pressure, -infinity, infinity, true},
      {"band_friction_coefficient", &fraction, 0.0, infinity, true},
      {reported_force, &force, 0.0, infinity, false},
      {"source_volume", &volume, 0.0, infinity, false},
      {"source_mean_thickness", &length, 0.0, infinity, false},
      {"deposit_volume", &volume, 0.0, infinity, false},
      {"deposit_area", &area, 0.0, infinity, false},
      {"travel_distance", &length, 0.0, infinity, false},
      {"drop_height", &length, -infinity, infinity, false},
      {"angle_of_reach", &angle, -90.0, 90.0, false},
  };
  return all;
}

const ReportedQuantity* reported_quantity(const std::string& name) {
  const std::string plain = periods_of(name) ? reported_force : name;
  const auto& all = reported_quantities();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& each) { return plain == each.name; });
  return found == all.end() ? nullptr : &*found;
}

std::string mistake_in_periods(const std::string& name) {
  const auto periods = periods_of(name);
  if (!periods ||
      (shortest_period <= periods->first && periods->first < periods->second && periods->second <= longest_period)) {
    return "";
  }
  return fmt::format("{}: give the shorter period first, both from {:g} to {:g} s", name, shortest_period,
                     longest_period);
}

}  // namespace thawslide::config
