#include "sim/between_bodies.hpp"

#include <cmath>

#include "base/instances.hpp"
#include "base/portability.hpp"
#include "config/body_layers.hpp"

namespace thawslide::sim {

template <class Real>
mpm::BetweenBodies<Real> between_bodies(const config::Case& parameters) {
  mpm::BetweenBodies<Real> between;
  const config::BodyLayers layers = config::body_layers(parameters);
  if (layers.count == 1) {
    return between;
  }
  between.layers = layers.count;
  for (const std::size_t layer : layers.of_body) {
    between.layer_of_body.push_back(static_cast<std::uint8_t>(layer));
  }
  for (const double angle : layers.friction_angle) {
    between.friction.push_back(static_cast<Real>(std::tan(angle * pi<double> / 180.0)));
  }
  return between;
}

template mpm::BetweenBodies<THAWSLIDE_REAL> between_bodies<THAWSLIDE_REAL>(const config::Case&);

}  // namespace thawslide::sim
