// terrain.csv: the ground a run slid on, for figures.
#pragma once

#include <filesystem>
#include <vector>

namespace thawslide::io {

// Columns distance_m, terrain_elevation_m.
void write_terrain_csv(const std::filesystem::path& file, const std::vector<double>& distance,
                       const std::vector<double>& elevation);

}  // namespace thawslide::io
