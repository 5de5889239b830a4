#include "io/terrain_csv.hpp"

#include "base/error.hpp"
#include "io/atomic_file.hpp"
#include "io/history_writer.hpp"

namespace thawslide::io {

void write_terrain_csv(const std::filesystem::path& file, const std::vector<double>& distance,
                       const std::vector<double>& elevation) {
  THAWSLIDE_ASSERT(distance.size() == elevation.size(), "{} distances, {} elevations", distance.size(),
                   elevation.size());
  std::string text = "distance_m,terrain_elevation_m\n";
  for (std::size_t k = 0; k < distance.size(); ++k) {
    text += shortest(distance[k]) + "," + shortest(elevation[k]) + "\n";
  }
  write_file_atomically(file, text);
}

}  // namespace thawslide::io
