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

// Reads a CSV file with the header distance_m,terrain_elevation_m[,surface_elevation_m]; lines that start with # and
// blank lines are skipped. Throws UserError with file and line for: a missing or unreadable file, a wrong header, a row
// of the wrong length, a value that is not a finite number, distances that do not increase, a surface below the ground,
// fewer than two rows.
ProfileTable read_profile(const std::filesystem::path& file);

}  // namespace thawslide::config
