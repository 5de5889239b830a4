#include "config/site.hpp"

namespace thawslide::config {

ProfileTable profile_of(const Case& parameters, const Site& site) {
  return site.profile.empty() ? read_profile(parameters.terrain.file) : site.profile;
}

}  // namespace thawslide::config
