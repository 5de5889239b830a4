// Consistency checks between keys of a case, and between keys and files.
#pragma once

#include "config/case.hpp"
#include "config/profile_csv.hpp"
#include "config/reading.hpp"

namespace thawslide::config {

inline constexpr const char* axis_names[] = {"x", "y", "z"};

// Adds a problem for each inconsistency. Skips checks of keys that already have a problem.
void check_case(const Case& checked, Reading& reading);

// Checks that the material named by a table exists.
void check_material(const Case& checked, const std::string& table, const std::string& name, Reading& reading);

// Checks terrain, bodies and frames. `profile` is empty if there is none, or if it could not be read.
void check_bodies(const Case& checked, const ProfileTable& profile, Reading& reading);

// Checks the ground: [basal], and [substrate.NAME] with its extent.
void check_grounds(const Case& checked, Reading& reading);

// Checks the erodible bed: [bed].
void check_bed(const Case& checked, Reading& reading);

// Excludes what is not available on cells that follow the terrain.
void check_cells(const Case& checked, Reading& reading);

// Checks other options that exclude each other.
void check_exclusions(const Case& checked, Reading& reading);

// Checks DEM, releases, map inputs of bodies, and probes. The contents of the maps are checked later.
void check_maps(const Case& checked, Reading& reading);

// Checks the width of a section; must follow the other checks.
void check_width(const Case& checked, Reading& reading);

// Checks that input files have different names, because a run keeps copies of all inputs in one folder.
void check_file_names(const Case& checked, Reading& reading);

}  // namespace thawslide::config
