// Profiles as CSV files: terrain.csv, the ground a run slid on, for figures; and those that cases read.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/profile_csv.hpp"

namespace thawslide::io {

// Columns distance_m, terrain_elevation_m, and surface_elevation_m where the profile has it; below the comments, a line
// each.
void write_profile_csv(const std::filesystem::path& file, const config::ProfileTable& profile,
                       const std::vector<std::string>& comments = {});

}  // namespace thawslide::io
