// Reported values to compare a run with, from the CSV file of report.targets: read before a run, so that a mistake in
// them is not told after it. What there is of quantities and units stands here; python/thawslide/targets.py, which
// compares, has the same (tests/cli/targets_test.py).
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
  bool have_clock = false;            // a row start_velocity: times are the reporter's, not the run's
  std::vector<std::string> mistakes;  // each with file and line
};

// Reads all rows that can be understood. A column kind says of each value whether it is an observation, the result of
// another model or an assumption, by which reports show them apart.
ReportedValues read_reported_values(const std::filesystem::path& file);

// What the user should know of values that are later than the run; empty where none is.
[[nodiscard]] std::string warning_of_late_values(const Case& parameters);

}  // namespace thawslide::config
