// Particles that join a run between two steps.
#pragma once

#include <cstdint>

#include "base/linear.hpp"

namespace thawslide::sim {

// Particle that joins a run; properties not listed here are those at t = 0.
template <int Dim>
struct NewParticle {
  std::int32_t body = 0, material = 0;                         // numbers, as in Model
  Vector<double, Dim> position = Vector<double, Dim>::Zero();  // relative to the domain's lower corner [m]
  Vector<double, Dim> velocity = Vector<double, Dim>::Zero();  // [m/s]
  double volume = 0;                                           // [m3], per metre of width in 2D
  double temperature = 0, porosity = 0;                        // [C], [1]
  double flow_depth = 0;  // below the surface, normal to the ground [m]: loads the ice
  SymmetricTensor<double> stress = SymmetricTensor<double>::Zero();  // total [Pa]
  double heat = 0;  // in addition to the heat content at its temperature [J]: it warms or melts the particle
};

}  // namespace thawslide::sim
