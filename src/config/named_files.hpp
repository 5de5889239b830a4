// Files that a case names.
#pragma once

#include <filesystem>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

struct InputFile {
  std::filesystem::path file;
  bool is_map = false;  // raster or vector data, which may have further files
};

// The case files, and every file that the case names, each once, absolute.
std::vector<InputFile> named_files(const Case& parameters);

}  // namespace thawslide::config
