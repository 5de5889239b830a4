// Reading of a case file into a validated Case.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

// Reads a TOML case file, or the case.toml of a folder. `sets` contains texts such as "band.thickness=0.1", each of
// which replaces a key. The right side is a TOML value, or a bare word for a string. Its paths are relative to the
// working directory and may lie anywhere, whereas paths in the file may not leave the file's folder.
//
// Case::name is the folder's name for a case.toml, otherwise FOLDER-FILE (cases/incline/DLP.toml: incline-DLP).
//
// Throws UserError with all problems found, one per line, each with file, line and column (or its `--set`), the value
// found, the values allowed and the remedy.
Case read_case(const std::filesystem::path& case_file_or_folder, const std::vector<std::string>& sets = {});

// The two parts of read_case: the texts of the case file and those it is based on, and the case that they specify. The
// second one reads no case file, and no working directory affects it if all paths are absolute.
std::vector<CaseFile> read_case_files(const std::filesystem::path& case_file_or_folder);
Case case_of(const std::vector<CaseFile>& files, const std::vector<Override>& overrides);

}  // namespace thawslide::config
