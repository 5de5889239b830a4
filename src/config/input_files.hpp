// The files that a case is read from, of which a run keeps copies.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

struct InputFile {
  std::string key;  // dotted, that names it; empty: the case file itself
  std::filesystem::path file;
};

// Every file that the case names, and its case files, each once, absolute. With a map come the files beside it that
// belong to it: the parts of a shapefile, and what tells a map's coordinate system and place.
std::vector<InputFile> input_files_by_key(const Case& parameters);
std::vector<std::filesystem::path> input_files(const Case& parameters);

}  // namespace thawslide::config
