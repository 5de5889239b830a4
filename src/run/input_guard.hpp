// Protection of inputs against being overwritten by a command. All functions throw UserError.
#pragma once

#include <filesystem>
#include <string>

#include "config/case.hpp"

namespace thawslide::run {

// Checks inputs that a run copies but does not otherwise read, such as files that accompany a map. If one is
// unreadable, the run to be replaced must still be intact.
void require_readable_inputs(const config::Case& parameters);

// Requires that no input lies in a folder that a run will replace.
void require_no_input_in(const std::filesystem::path& folder, const config::Case& parameters);

// Requires that no input is the output file specified by a command-line option.
void require_no_input_at(const std::filesystem::path& file, const std::string& option, const config::Case& parameters);

}  // namespace thawslide::run
