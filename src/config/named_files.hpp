// Files that a case names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

struct InputFile {
  std::string key;  // dotted key that names the file; empty: the case file itself
  std::filesystem::path file;
  bool is_map = false;  // raster or vector data, which may have further files
};

// The case files, and every file that the case names, each once, absolute.
std::vector<InputFile> named_files(const Case& parameters);

}  // namespace thawslide::config
