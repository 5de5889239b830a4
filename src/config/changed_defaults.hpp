// Defaults that were the paper's forms in earlier versions. A case file that gives none of these keys was written
// before, and gets one notice; the tests of the paper's equations take the former values from here.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

struct ChangedDefault {
  std::string table;  // "band"; "material.NAME": of each material
  std::string key;
  std::string before;  // as TOML, and so is `now`
  std::string now;
  bool (*matters)(const Case&);  // whether a case feels it
};

const std::vector<ChangedDefault>& changed_defaults();

// One notice that says what changed for this case; empty where its file gives any of the keys, or feels none.
std::string notice_of_moved_defaults(const Case& parameters);

}  // namespace thawslide::config
