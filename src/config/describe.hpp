// The reference of the case file, and a case written out whole; all from the declarations.
#pragma once

#include <filesystem>
#include <string>

#include "config/case.hpp"

namespace thawslide::config {

// The reference of every key: as plain text, JSON, Markdown; and a JSON schema for editors.
std::string describe_text();
std::string describe_json();
std::string describe_markdown();
std::string schema_json();

// A case file with every default written out and units beside the values; reads back to the same case. Its inputs are
// named as files of `input_folder`, told relative to the case file.
std::string resolved_toml(const Case& parameters, const std::filesystem::path& input_folder);

}  // namespace thawslide::config
