// Map files of a case, if this build can read them.
#pragma once

#include "app/warnings.hpp"
#include "config/case.hpp"
#include "config/site.hpp"

namespace thawslide::app {

// Contents of the map files; empty for a case without any. Throws UserError for a build without GDAL.
config::Site read_map_files(const config::Case& parameters, Warnings& warnings);

}  // namespace thawslide::app
