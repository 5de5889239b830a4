// `--set key=value` texts of the command line.
#pragma once

#include <string>
#include <vector>

#include "config/reading.hpp"

namespace thawslide::config {

// Splits "band.thickness=0.1" at the first '='. Throws UserError if there is no '=' or no key.
Override parse_override(const std::string& text);

// Inserts the values of reading.overrides into the tables, replacing those of the file.
void apply_overrides(toml::table& root, Reading& reading);

}  // namespace thawslide::config
