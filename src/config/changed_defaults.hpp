// Defaults that were the published formulations in earlier versions. A case file without any of these keys predates the
// change and gets one notice. Tests of the published equations take the former values from here.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

struct ChangedDefault {
  std::string table;  // "band"; "material.NAME" for each material
  std::string key;
  std::string before;  // as TOML, as `now`
  std::string now;
  bool (*affects)(const Case&);  // true if the change affects a case
};

const std::vector<ChangedDefault>& changed_defaults();

// Notice of the changes that affect this case; empty if its file gives any of the keys, or none has an effect.
std::string changed_defaults_warning(const Case& parameters);

}  // namespace thawslide::config
