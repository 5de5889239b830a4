// Map data of a case: ground, releases, path and probes.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"
#include "config/site.hpp"

namespace thawslide::gis {

struct SiteAndWarnings {
  config::Site site;
  std::vector<std::string> warnings;  // from the reading: a sentence each, without a full stop
};

// Reads and checks all of them. Throws UserError at the location of the key that named a file.
[[nodiscard]] SiteAndWarnings load_site(const config::Case& parameters);

}  // namespace thawslide::gis
