// The map files of a case, where this build can read them, and what a user should know of a case before it runs.
#pragma once

#include "config/case.hpp"
#include "config/site.hpp"

namespace thawslide::app {

// What the map files hold; nothing for a case without any. Prints what the reader of the case should know of them.
// Throws UserError for a build without GDAL.
config::Site read_map_files(const config::Case& parameters);

// Prints what to know of the cells of the maps to come, if there is anything.
void print_map_note(const config::Case& parameters, const config::Site& site);

// Prints what is sound but unusual in the case.
void print_notices(const config::Case& parameters);

}  // namespace thawslide::app
