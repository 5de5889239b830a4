// What the map files of a case tell: the ground, the releases, the path and the probes.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"
#include "config/site.hpp"

namespace thawslide::gis {

struct SiteAndWarnings {
  config::Site site;
  std::vector<std::string> warnings;  // what the user should know of the reading: a sentence each, without a full stop
};

// Reads and checks all of them. Throws UserError at the place of the key that named a file.
[[nodiscard]] SiteAndWarnings load_site(const config::Case& parameters);

}  // namespace thawslide::gis
