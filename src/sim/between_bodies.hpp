// Builds the parameters of contact between bodies from the case.
#pragma once

#include <cmath>

#include "base/portability.hpp"
#include "config/body_layers.hpp"
#include "config/case.hpp"
#include "mpm/between_bodies.hpp"

namespace thawslide::sim {

[[nodiscard]] inline mpm::BetweenBodies between_bodies(const config::Case& parameters) {
  mpm::BetweenBodies between;
  const config::BodyLayers layers = config::body_layers(parameters);
  if (layers.count == 1) {
    return between;
  }
  between.layers = layers.count;
  for (const std::size_t layer : layers.of_body) {
    between.layer_of_body.push_back(static_cast<std::uint8_t>(layer));
  }
  for (const double angle : layers.friction_angle) {
    between.friction.push_back(static_cast<Real>(std::tan(angle * pi / 180.0)));
  }
  return between;
}

}  // namespace thawslide::sim
