// Layers of a case: a case file, those on which it is based, and `--set` texts. Keys of a layer replace those below it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "config/case.hpp"
#include "config/reading.hpp"

namespace thawslide::config {

struct LayeredCase {
  toml::table root;
  // Lines of each file, by name, whose keys the program wrote as defaults.
  std::map<std::string, std::set<std::uint32_t>> lines_not_given;
};

// End of the line of such a key in the resolved case of a run.
inline constexpr const char* not_given_mark = "not given";

// Reads a case file and its chain of case.based_on. Throws UserError for an invalid file or a cycle.
std::vector<CaseFile> read_with_bases(const std::filesystem::path& file);

// Merges the first of these files over the others. Nodes keep their original locations.
LayeredCase merged(const std::vector<CaseFile>& files);

// Splits "band.thickness=0.1" at the first '='. Throws UserError if there is no '=' or no key.
Override parse_override(const std::string& text);

// Inserts the values of reading.overrides into the tables, replacing those of the file.
void apply_overrides(toml::table& root, Reading& reading);

}  // namespace thawslide::config
