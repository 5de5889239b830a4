// Functions shared by the commands that make a case folder from maps.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/commands.hpp"
#include "config/case.hpp"
#include "config/case_proposal.hpp"
#include "config/site.hpp"

namespace thawslide::app {

inline constexpr const char* body_name = "slide";

// Throws UserError: the file requires GDAL, which this build lacks.
[[noreturn]] void fail_without_gis(const std::string& file);

// Case over the whole DEM for inspecting the files, without a body if no release is given. Requires GDAL.
config::Case trial_case(const std::string& folder, const MapOptions& maps);

// Reads the map files of such a case and prints warnings. A UserError names options, not keys. Requires GDAL.
config::Site open_site(const config::Case& trial);

// Sets the taper of an excavated release, so that the slide can leave the pit, and reports where space is missing.
config::EdgeTaper taper_edges(config::Case& trial, const config::Site& site);

// The same as open_site for files already inspected: prints nothing.
config::Site reopen_site(const config::Case& trial);

// Throws UserError if a name is not UTF-8, as a case file is. File systems accept any bytes. `what`: subject of the
// message.
void require_utf8(const std::string& what, const std::string& name);

// Last component of a folder's path.
std::string title_of(const std::filesystem::path& folder);

// Base of the case in a folder by the rigid block, or nothing if it has no path.
std::optional<config::ProposedBase> base_by_block(const std::filesystem::path& folder);

// Lines that state a proposed base.
std::string base_text(const config::ProposedBase& base);

// Creates the folder. Throws UserError if it exists and is not empty.
void make_new_folder(const std::filesystem::path& folder);

// Prints the commands to continue with in a new case folder. `program`: as called by the user.
void print_next_commands(const std::string& program, const std::filesystem::path& folder);

}  // namespace thawslide::app
