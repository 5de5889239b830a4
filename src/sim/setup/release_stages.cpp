#include "sim/setup/release_stages.hpp"

#include <algorithm>
#include <cmath>

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

bool is_held(const std::vector<double>& times, double time, std::size_t body) {
  return !times.empty() && time < times[body] * (1.0 - round_off);
}

double next_release(const std::vector<double>& times, double time) {
  double next = HUGE_VAL;
  for (std::size_t body = 0; body < times.size(); ++body) {
    next = is_held(times, time, body) ? std::min(next, times[body]) : next;
  }
  return next;
}

}  // namespace thawslide::sim
