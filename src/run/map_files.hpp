// Map files of a case, if this build can read them.
#pragma once

#include "config/case.hpp"
#include "config/site.hpp"
#include "run/warnings.hpp"

namespace thawslide::run {

// Contents of the map files; empty for a case without any. Throws UserError for a build without GDAL.
config::Site read_map_files(const config::Case& parameters, Warnings& warnings);

}  // namespace thawslide::run
