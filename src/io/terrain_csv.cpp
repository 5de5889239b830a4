#include "io/terrain_csv.hpp"

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "io/history_writer.hpp"

namespace thawslide::io {

void write_profile_csv(const std::filesystem::path& file, const config::ProfileTable& profile,
                       const std::vector<std::string>& comments) {
  THAWSLIDE_ASSERT(profile.distance.size() == profile.terrain.size() &&
                       (profile.surface.empty() || profile.surface.size() == profile.terrain.size()),
                   "{} distances, {} elevations, {} of a surface", profile.distance.size(), profile.terrain.size(),
                   profile.surface.size());
  std::string text;
  for (const std::string& comment : comments) {
    text += "# " + comment + "\n";
  }
  text += profile.surface.empty() ? "distance_m,terrain_elevation_m\n"
                                  : "distance_m,terrain_elevation_m,surface_elevation_m\n";
  for (std::size_t k = 0; k < profile.distance.size(); ++k) {
    text += shortest(profile.distance[k]) + "," + shortest(profile.terrain[k]);
    text += profile.surface.empty() ? "\n" : "," + shortest(profile.surface[k]) + "\n";
  }
  write_file_atomically(file, text);
}

}  // namespace thawslide::io
