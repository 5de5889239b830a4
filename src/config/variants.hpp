// Case file that is based on another one of its folder: the keys of the base apply unless replaced.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "config/case_source.hpp"
#include "config/toml.hpp"

namespace thawslide::config {

struct LayeredCase {
  toml::table root;
  // Lines of each file, by name, whose keys the program wrote as defaults.
  std::map<std::string, std::set<std::uint32_t>> lines_not_given;
};

// End of the line of such a key in the resolved case of a run.
inline constexpr const char* not_given_mark = "not given";

// Reads a case file, the file named by its case.based_on, the base of that ... Throws UserError for a file that is
// unreadable, empty or not TOML, and for a base that is missing or forms a cycle.
std::vector<CaseFile> read_with_bases(const std::filesystem::path& file);

// Merges the first of these files over the others. Nodes keep their original locations.
LayeredCase merged(const std::vector<CaseFile>& files);

}  // namespace thawslide::config
