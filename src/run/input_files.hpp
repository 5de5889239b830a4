// Input files of a case, which a run copies, and their protection against being overwritten. All throw UserError.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::run {

// Case files, files that the case names, and those of map data sets, absolute. Throws UserError for two of one name.
[[nodiscard]] std::vector<std::filesystem::path> input_files(const config::Case& parameters);

// Checks inputs that a run only copies: if one is unreadable, the run to be replaced must still be intact.
void require_readable_inputs(const config::Case& parameters);

// Requires that no input lies in a folder that a run will replace.
void require_no_input_in(const std::filesystem::path& folder, const config::Case& parameters);

// Requires that no input is the output file specified by a command-line option.
void require_no_input_at(const std::filesystem::path& file, const std::string& option, const config::Case& parameters);

}  // namespace thawslide::run
