// Quantities reported for slides, and their units.
#pragma once

#include <string>
#include <vector>

namespace thawslide::config {

struct ReportedUnit {
  const char* name;
  double factor = 1.0;  // to the first unit of its quantity
  double offset = 0.0;
};

struct ReportedQuantity {
  const char* name;
  const std::vector<ReportedUnit>* units;
  double low, high;  // allowed, in the first unit
  bool is_of_a_time;
};

inline constexpr const char* sets_clock = "start_velocity";
inline constexpr const char* reported_force = "max_seismic_force";

[[nodiscard]] const std::vector<ReportedQuantity>& reported_quantities();

// Null for an unknown name. A force between periods, max_seismic_force_35_150_s, is a force.
[[nodiscard]] const ReportedQuantity* reported_quantity(const std::string& name);

// Mistake in the periods of such a force; empty if there is none, or no periods.
[[nodiscard]] std::string mistake_in_periods(const std::string& name);

}  // namespace thawslide::config
