// Motion of one of several bodies.
#pragma once

#include <algorithm>
#include <limits>
#include <utility>

#include "sim/simulation.hpp"

namespace thawslide::testing_support {

template <int Dim>
struct BodyMotion {
  double mass = 0.0, farthest = 0.0;  // [kg]; largest displacement of a particle [m]
  Vector<double, Dim> velocity = Vector<double, Dim>::Zero(), displacement = Vector<double, Dim>::Zero();  // means

  BodyMotion(const sim::Simulation<Dim>& simulation, int body) {
    const auto& particles = simulation.particles();
    for (std::size_t p = 0; p < particles.size(); ++p) {
      if (particles.body(p) == body) {
        const auto moved = particles.displacement.template get<Vector<double, Dim>>(p);
        mass += particles.mass(p);
        velocity += particles.mass(p) * particles.velocity.template get<Vector<double, Dim>>(p);
        displacement += particles.mass(p) * moved;
        farthest = std::max(farthest, moved.norm());
      }
    }
    velocity /= mass;
    displacement /= mass;
  }
};

// Least and greatest position of the particles of a body along a direction [m].
template <int Dim>
std::pair<double, double> extent_of(const sim::Simulation<Dim>& simulation, int body,
                                    const Vector<double, Dim>& direction) {
  std::pair<double, double> extent(std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest());
  const auto& particles = simulation.particles();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (particles.body(p) == body) {
      const double along = particles.position.template get<Vector<double, Dim>>(p).dot(direction);
      extent = {std::min(extent.first, along), std::max(extent.second, along)};
    }
  }
  return extent;
}

// Gap between the particles of the first body and those of the second one along x [m].
template <int Dim>
double gap_along_x(const sim::Simulation<Dim>& simulation, double spacing) {
  const Vector<double, Dim> along = Vector<double, Dim>::Unit(0);
  return extent_of<Dim>(simulation, 1, along).first - extent_of<Dim>(simulation, 0, along).second - spacing;
}

}  // namespace thawslide::testing_support
