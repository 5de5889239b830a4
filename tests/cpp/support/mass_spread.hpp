// Spread of the mass of a slide.
#pragma once

#include <cmath>

#include "sim/simulation.hpp"

namespace thawslide::testing_support {

// Standard deviation of the mass along x [m].
inline double mass_spread(const sim::Simulation<2>& simulation) {
  const auto& particles = simulation.particles();
  double mass = 0.0, first = 0.0, second = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double x = particles.position(p, 0);
    mass += particles.mass(p);
    first += particles.mass(p) * x;
    second += particles.mass(p) * x * x;
  }
  return std::sqrt(second / mass - first / mass * first / mass);
}

}  // namespace thawslide::testing_support
