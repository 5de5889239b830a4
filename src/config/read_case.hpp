// Reading of a case file into a validated Case.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

// Reads a case file, or the case.toml of a folder, with `sets` such as "band.thickness=0.1", with paths relative to
// the working directory. Paths in the file may not leave its folder. Throws UserError with all problems found.
Case read_case(const std::filesystem::path& case_file_or_folder, const std::vector<std::string>& sets = {});

// The two parts of read_case: texts of the case file and those it is based on; the case, without reading case files.
std::vector<CaseFile> read_case_files(const std::filesystem::path& case_file_or_folder);
Case case_of(const std::vector<CaseFile>& files, const std::vector<Override>& overrides);

}  // namespace thawslide::config
