// Checks of other input files: unique names for the copies in a run folder. Python reads reported values and force
// records.
#include <fmt/format.h>

#include "config/checks.hpp"
#include "config/named_files.hpp"

namespace thawslide::config {

namespace {

// Names must be unique, because a run keeps copies of all inputs in one folder.
void check_file_names(const Case& checked, Reading& reading) {
  const std::vector<InputFile> files = named_files(checked);
  for (std::size_t later = 1; later < files.size(); ++later) {
    for (std::size_t earlier = 0; earlier < later; ++earlier) {
      const auto& [key, file, is_map] = files[later];
      const auto& [other_key, other, other_is_map] = files[earlier];
      if (file.filename() == other.filename() && reading.are_valid({key, other_key})) {
        reading.report_misfit(
            {key, other_key.empty() ? key : other_key},
            fmt::format("{} leads to {}, and {} {}; allowed: names of their own, since a run keeps copies of all its "
                        "inputs in one folder. Rename one.",
                        key, file.string(), other_key.empty() ? "the case file is" : other_key + " to",
                        other.string()));
      }
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

}  // namespace

void check_files(const Case& checked, Reading& reading) {
  check_file_names(checked, reading);
  check_force_periods(checked, reading);
}

}  // namespace thawslide::config
