#include "sim/release_times.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "config/body_layers.hpp"

namespace thawslide::sim {

std::vector<double> release_times(const config::Case& parameters, const config::Site& site, std::size_t bodies) {
  if (!config::has_stages(parameters)) {
    return {};
  }
  std::vector<double> times(bodies, 0.0);
  std::size_t number = 0;
  for (const auto& [name, body] : parameters.bodies) {
    double& time = times[number++];
    time = body.release_time.number;
    if (!body.release_time.attribute.empty()) {
      const auto release = site.releases.find(name);
      THAWSLIDE_ASSERT(release != site.releases.end(), "body.{} has a release time of polygons, and no release", name);
      time = release->second.release_time;
    }
  }
  const bool all_at_once = std::all_of(times.begin(), times.end(), [](double time) { return time == 0.0; });
  return all_at_once ? std::vector<double>{} : times;
}

}  // namespace thawslide::sim
