// Force inverted from seismic waves, from the CSV file of report.force_record. It is read before a run, so that
// mistakes in it are reported before the run starts. python/thawslide/force_record.py, which makes the comparison, has
// the same rules (tests/cli/targets_test.py).
#pragma once

#include <filesystem>
#include <string>

namespace thawslide::config {

// Returns the first mistake in the file, with file and line; empty if there is none.
[[nodiscard]] std::string mistake_in_force_record(const std::filesystem::path& file);

}  // namespace thawslide::config
