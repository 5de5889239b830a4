// A force that was inverted from seismic waves, from the CSV file of report.force_record: read before a run, so that a
// mistake in it is not told after it. python/thawslide/force_record.py, which compares, has the same rules
// (tests/cli/force_record_test.py).
#pragma once

#include <filesystem>
#include <string>

namespace thawslide::config {

// What is wrong with the file, with file and line; empty where nothing is.
[[nodiscard]] std::string mistake_in_force_record(const std::filesystem::path& file);

}  // namespace thawslide::config
