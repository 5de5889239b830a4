// What commands that make a case folder from maps have in common.
#pragma once

#include <filesystem>
#include <string>

#include "app/commands.hpp"
#include "config/case.hpp"
#include "config/site.hpp"
#include "config/taper_proposal.hpp"

namespace thawslide::app {

inline constexpr const char* body_name = "slide";

// Throws UserError: this build has no GDAL, which the file needs.
[[noreturn]] void fail_without_gis(const std::string& file);

// A case over the whole DEM, to look at what the files hold: without a body where no release is given. For builds with
// GDAL.
config::Case trial_case(const std::string& folder, const MapOptions& maps);

// What the map files of such a case hold; prints what the user should know of them. A UserError names options, not
// keys. For builds with GDAL.
config::Site open_site(const config::Case& trial);

// Gives the release of such a case, which is to be cut out of the DEM, the taper that lets the slide get out, and says
// where there is no room for it. `site`: of the case so far, with nothing cut out. For builds with GDAL.
config::EdgeTaper taper_edges(config::Case& trial, const config::Site& site);

// As open_site, for files that were looked at before: prints nothing.
config::Site reopen_site(const config::Case& trial);

// The last part of a folder's path.
std::string title_of(const std::filesystem::path& folder);

// Makes the folder. Throws UserError where there is something in it already.
void make_new_folder(const std::filesystem::path& folder);

// What to do with a case folder that was made. `program`: as it was called.
void print_next_commands(const std::string& program, const std::filesystem::path& folder);

}  // namespace thawslide::app
