// Terrain profile from a CSV file.
#pragma once

#include <filesystem>
#include <vector>

namespace thawslide::config {

// Elevations along a section; each shape [number of rows].
struct ProfileTable {
  std::vector<double> distance;  // m, strictly increasing
  std::vector<double> terrain;   // m, elevation of the rigid ground
  std::vector<double> surface;   // m, elevation of the body's surface, at least terrain; empty without that column

  [[nodiscard]] bool empty() const { return distance.empty(); }
  // Elevation of the ground [m], linear between rows; the end segments continue beyond the ends.
  [[nodiscard]] double terrain_at(double x) const;
};

// Reads the columns distance_m,terrain_elevation_m[,surface_elevation_m], without blank lines and comments (#).
// Throws UserError, with file and line, for an invalid file.
ProfileTable read_profile(const std::filesystem::path& file);

}  // namespace thawslide::config
