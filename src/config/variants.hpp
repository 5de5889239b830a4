// A case file that is based on another one of its folder: the other's keys hold wherever it gives nothing else.
#pragma once

#include <filesystem>
#include <vector>

#include "config/toml.hpp"

namespace thawslide::config {

struct LayeredCase {
  toml::table root;
  std::vector<std::filesystem::path> files;  // the case file, what it is based on, what that is based on ...
};

// A case file as TOML, laid over the file that [case] based_on names, and so on. Nodes keep the places they were
// written at. Throws UserError for a file that is unreadable, empty or not TOML, and for a base that is not there or
// leads back.
LayeredCase read_with_bases(const std::filesystem::path& file);

}  // namespace thawslide::config
