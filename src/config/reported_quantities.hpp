// The quantities that reports of a slide tell, and their units.
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

// Null where there is none of that name. A force between periods, max_seismic_force_35_150_s, is a force.
[[nodiscard]] const ReportedQuantity* reported_quantity(const std::string& name);

// What is wrong with the periods of such a force; empty: nothing, or it has none.
[[nodiscard]] std::string mistake_in_periods(const std::string& name);

}  // namespace thawslide::config
