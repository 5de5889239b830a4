// Reported values for comparison with a run, from the CSV file of report.targets, read before a run so that mistakes
// are reported early. The list of quantities and units is repeated in python/thawslide/targets.py, which makes the
// comparison (tests/cli/targets_test.py).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

struct ReportedValue {
  std::string quantity;
  double time = 0.0;  // [s]
  int line = 0;
  bool is_of_a_time = false;  // compared with the run at that time
};

struct ReportedValues {
  std::vector<ReportedValue> values;
  bool has_clock = false;             // has a row start_velocity: times are the reporter's, not the run's
  std::vector<std::string> mistakes;  // each with file and line
};

// True for the name of a quantity, and for a force between periods, such as max_seismic_force_35_150_s.
[[nodiscard]] bool is_reported_quantity(const std::string& name);

// Reads all valid rows. The column kind marks each value as an observation, the result of another model or an
// assumption, which reports distinguish.
ReportedValues read_reported_values(const std::filesystem::path& file);

// Warning of values that are later than the end of the run; empty if there are none.
[[nodiscard]] std::string warning_of_late_values(const Case& parameters);

}  // namespace thawslide::config
