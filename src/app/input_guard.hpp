// What a command writes must not take away what it reads. All throw UserError.
#pragma once

#include <filesystem>
#include <string>

#include "config/case.hpp"

namespace thawslide::app {

// Of what a run will copy some is not read before, as what lies beside a map: a run that is to be replaced must still
// be there when that cannot be read.
void require_readable_inputs(const config::Case& parameters);

// No input may lie in a folder that a run is to replace.
void require_no_input_in(const std::filesystem::path& folder, const config::Case& parameters);

// No input may be the file that an option of the command line says to write.
void require_no_input_at(const std::filesystem::path& file, const std::string& option, const config::Case& parameters);

}  // namespace thawslide::app
