// Input files of a case, which a run copies.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

struct InputFile {
  std::string key;  // dotted key that names the file; empty: the case file itself
  std::filesystem::path file;
};

// Every file that the case names, and its case files, each once, absolute. A map includes its companion files: the
// parts of a shapefile, and files with coordinate system and georeference.
std::vector<InputFile> input_files_by_key(const Case& parameters);
std::vector<std::filesystem::path> input_files(const Case& parameters);

}  // namespace thawslide::config
