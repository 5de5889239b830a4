#include "config/site.hpp"

namespace thawslide::config {

ProfileTable profile_of(const Case& parameters, const Site& site) {
  return site.profile.empty() ? read_profile(parameters.terrain.file) : site.profile;
}

NamedFigures named(const Roughness& ground) {
  return {{"noise_m", ground.noise},
          {"noise_cells", ground.noise / ground.cell},
          {"spacing_m", ground.spacing},
          {"bump_length_m", ground.bump_length},
          {"bump_slope", ground.bump_slope},
          {"filter_m", ground.width},
          {"remaining_slope", ground.remaining_slope},
          {"apparent_friction", ground.apparent_friction},
          {"narrow_valley_m", ground.narrow_valley}};
}

}  // namespace thawslide::config
