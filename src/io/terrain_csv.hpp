// Profiles as CSV files: terrain.csv, the ground of a run, for figures; and input profiles of cases.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/profile_csv.hpp"

namespace thawslide::io {

// Columns distance_m, terrain_elevation_m, and surface_elevation_m if the profile has it; preceded by the comments, one
// per line.
void write_profile_csv(const std::filesystem::path& file, const config::ProfileTable& profile,
                       const std::vector<std::string>& comments = {});

}  // namespace thawslide::io
