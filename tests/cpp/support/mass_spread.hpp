// Spread of the mass of a slide.
#pragma once

#include <cmath>

#include "sim/simulation.hpp"

namespace thawslide::testing_support {

// Standard deviation of the mass along a direction [m].
inline double mass_spread(const sim::Simulation<2>& simulation, const Vector<double, 2>& direction = {1.0, 0.0}) {
  const auto& particles = simulation.particles();
  double mass = 0.0, first = 0.0, second = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double along = particles.position.get<Vector<double, 2>>(p).dot(direction);
    mass += particles.mass(p);
    first += particles.mass(p) * along;
    second += particles.mass(p) * along * along;
  }
  return std::sqrt(second / mass - first / mass * first / mass);
}

}  // namespace thawslide::testing_support
