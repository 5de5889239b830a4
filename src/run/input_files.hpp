// All input files of a case, which a run copies.
#pragma once

#include <filesystem>
#include <vector>

#include "config/case.hpp"

namespace thawslide::run {

// Case files and every file that the case names, each once, absolute; a map with all files of its data set. Throws
// UserError if two of them have the same name.
[[nodiscard]] std::vector<std::filesystem::path> input_files(const config::Case& parameters);

}  // namespace thawslide::run
