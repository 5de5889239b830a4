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

// Case file with every default, which reads as the same case. Inputs are named as files of `input_folder`.
std::string resolved_toml(const Case& parameters, const std::filesystem::path& input_folder);

}  // namespace thawslide::config
