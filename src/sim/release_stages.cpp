// Release in stages: a body is held until its release time. Held bodies have separate nodes, which are fixed.
#include <algorithm>
#include <cmath>

#include "base/instances.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

// A step that ends at the release time to round-off releases the body.
template <int Dim>
bool Simulation<Dim>::is_held(std::size_t body) const {
  const std::vector<double>& times = model_.release_times;
  return !times.empty() && time_ < times[body] * (1.0 - round_off);
}

template <int Dim>
double Simulation<Dim>::next_release() const {
  double next = HUGE_VAL;
  for (std::size_t body = 0; body < model_.release_times.size(); ++body) {
    next = is_held(body) ? std::min(next, model_.release_times[body]) : next;
  }
  return next;
}

template <int Dim>
void Simulation<Dim>::update_layers() {
  const mpm::BetweenBodies& between = model_.between_bodies;
  if (!between.has_held) {
    return;
  }
  std::vector<std::uint8_t> layers = between.layer_of_body;
  for (std::size_t body = 0; body < layers.size(); ++body) {
    layers[body] = static_cast<std::uint8_t>(layers[body] + (is_held(body) ? between.layers : 0));
  }
  grid_.set_layers(std::move(layers));
}

#define THAWSLIDE_INSTANTIATE(Dim)                           \
  template bool Simulation<Dim>::is_held(std::size_t) const; \
  template double Simulation<Dim>::next_release() const;     \
  template void Simulation<Dim>::update_layers();
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
