// A case file that is based on another one of its folder: the other's keys hold wherever it gives nothing else.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "config/toml.hpp"

namespace thawslide::config {

struct LayeredCase {
  toml::table root;
  std::vector<std::filesystem::path> files;  // the case file, what it is based on, what that is based on ...
  // Of each of them, by its name: lines whose keys were written by us, at their defaults.
  std::map<std::string, std::set<std::uint32_t>> lines_not_given;
};

// What ends the line of such a key in the resolved case of a run.
inline constexpr const char* not_given_mark = "not given";

// A case file as TOML, laid over the file that [case] based_on names, and so on. Nodes keep the places they were
// written at. Throws UserError for a file that is unreadable, empty or not TOML, and for a base that is not there or
// leads back.
LayeredCase read_with_bases(const std::filesystem::path& file);

}  // namespace thawslide::config
