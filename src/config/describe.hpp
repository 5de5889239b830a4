// Reference of the case file, and complete case files, generated from the declarations.
#pragma once

#include <filesystem>
#include <string>

#include "config/case.hpp"

namespace thawslide::config {

// Reference of every key as plain text, JSON, Markdown, and as a JSON schema for editors.
std::string describe_text();
std::string describe_json();
std::string describe_markdown();
std::string schema_json();

// Case file with every default written out and units in comments; reading it gives the same case. Its inputs are named
// as files of `input_folder`, relative to the case file.
std::string resolved_toml(const Case& parameters, const std::filesystem::path& input_folder);

}  // namespace thawslide::config
