// Reads a case file into a checked Case.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

// Reads a TOML case file, or the case.toml of a folder. `sets` holds texts such as "band.thickness=0.1", each of which
// replaces a key: the right side is a TOML value, or a bare word, which stands for a text; paths in it are told from
// the working directory and may lie anywhere, whereas paths in the file may not leave the file's folder.
//
// Case::name is the folder's name for a case.toml, else FOLDER-FILE (cases/incline/DLP.toml: incline-DLP).
//
// Throws UserError with all problems found, one a line, each with file, line and column (or its `--set`), what was
// found, what is allowed and what to do.
Case read_case(const std::filesystem::path& case_file_or_folder, const std::vector<std::string>& sets = {});

}  // namespace thawslide::config
