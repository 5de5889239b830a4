// Sums over all particles for the run monitor (sim/between_steps/monitor.hpp).
#pragma once

#include <cstdint>

#include "base/linear.hpp"
#include "mpm/kernel_totals.hpp"

namespace thawslide::mpm {

struct MonitorSums {
  double kinetic = 0, potential = 0;  // [J]
  double mass = 0, fast_mass = 0;     // [kg]
  InvalidParticle volumes;            // volume out of range, smallest id

  THAWSLIDE_HD MonitorSums& operator+=(const MonitorSums& part) {
    kinetic += part.kinetic;
    potential += part.potential;
    mass += part.mass;
    fast_mass += part.fast_mass;
    volumes += part.volumes;
    return *this;
  }
};

template <int Dim>
struct MonitorKernel {
  using Sums = MonitorSums;

  Vector<double, Dim> gravity, origin;     // [m/s2]; of positions [m]
  double fast_distance;                    // displacement in a step above which a particle counts as fast [m]
  double smallest_volume, largest_volume;  // relative to the volume at t = 0

  template <class Particles>
  [[nodiscard]] THAWSLIDE_HD MonitorSums operator()(const Particles& particles, std::uint32_t p) const {
    const double mass = particles.mass(p);
    double speed2 = 0, way2 = 0;
    MonitorSums seen;
    for (int a = 0; a < Dim; ++a) {
      speed2 += particles.velocity(p, a) * particles.velocity(p, a);
      way2 += particles.step_displacement(p, a) * particles.step_displacement(p, a);
      seen.potential -= mass * gravity[a] * (particles.position(p, a) + origin[a]);
    }
    seen.mass = mass;
    seen.fast_mass = way2 > fast_distance * fast_distance ? mass : 0.0;
    seen.kinetic = 0.5 * mass * speed2;
    const double ratio = particles.volume(p) / particles.initial_volume(p);
    if (ratio < smallest_volume || ratio > largest_volume) {
      seen.volumes.record(particles.id(p), ratio < smallest_volume ? Fault::volume_too_small : Fault::volume_too_large);
    }
    return seen;
  }
};

}  // namespace thawslide::mpm
