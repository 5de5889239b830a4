// Release in stages: a body is held until its release time. Held bodies have separate nodes, which are fixed.
#pragma once

#include <cstdint>
#include <vector>

#include "config/site.hpp"
#include "sim/setup/model.hpp"

namespace thawslide::sim {

// Release times of a number of bodies [s], in the order of the case; 0 for those that the case does not contain. Empty
// if all bodies are released at the start.
[[nodiscard]] std::vector<double> release_times(const config::Case& parameters, const config::Site& site,
                                                std::size_t bodies);

// True until the release time of a body. times: by body, or empty. A step that ends at the release time to round-off
// releases the body.
[[nodiscard]] bool is_held(const std::vector<double>& times, double time, std::size_t body);

// Time of the next release [s]; infinite if no body is held.
[[nodiscard]] double next_release(const std::vector<double>& times, double time);

// Layers of the grid by body, with separate ones for held bodies.
template <int Dim>
[[nodiscard]] std::vector<std::uint8_t> layers_of_bodies(const Model<Dim>& model, double time) {
  const mpm::BetweenBodies& between = model.between_bodies;
  std::vector<std::uint8_t> layers = between.layer_of_body;
  for (std::size_t body = 0; body < layers.size(); ++body) {
    layers[body] =
        static_cast<std::uint8_t>(layers[body] + (is_held(model.release_times, time, body) ? between.layers : 0));
  }
  return layers;
}

}  // namespace thawslide::sim
