// Consistency checks between keys of a case, and between keys and files.
#pragma once

#include "config/case.hpp"
#include "config/profile_csv.hpp"
#include "config/reading.hpp"

namespace thawslide::config {

inline constexpr const char* axis_names[] = {"x", "y", "z"};

// Adds a problem for each inconsistency. Skips checks of keys that already have a problem.
void check_case(const Case& checked, Reading& reading);

// Parts of check_case; check_width must be the last. `profile` is empty if there is none, or if it could not be read.
void check_cells(const Case& checked, Reading& reading);
void check_grounds(const Case& checked, Reading& reading);
void check_bed(const Case& checked, Reading& reading);
void check_exclusions(const Case& checked, Reading& reading);
void check_bodies(const Case& checked, const ProfileTable& profile, Reading& reading);
void check_maps(const Case& checked, Reading& reading);
void check_width(const Case& checked, Reading& reading);

// Checks that the material named by a table exists.
void check_material(const Case& checked, const std::string& table, const std::string& name, Reading& reading);

}  // namespace thawslide::config
