// All input files of a case, which a run copies.
// Protection of inputs against being overwritten by a command. All functions throw UserError.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::run {

// Case files and every file that the case names, each once, absolute; a map with all files of its data set. Throws
// UserError if two of them have the same name.
[[nodiscard]] std::vector<std::filesystem::path> input_files(const config::Case& parameters);

// Checks inputs that a run copies but does not otherwise read, such as files that accompany a map. If one is
// unreadable, the run to be replaced must still be intact.
void require_readable_inputs(const config::Case& parameters);

// Requires that no input lies in a folder that a run will replace.
void require_no_input_in(const std::filesystem::path& folder, const config::Case& parameters);

// Requires that no input is the output file specified by a command-line option.
void require_no_input_at(const std::filesystem::path& file, const std::string& option, const config::Case& parameters);

}  // namespace thawslide::run
