// Particles that join a run between two steps.
#pragma once

#include <cstdint>
#include <vector>

#include "base/linear.hpp"
#include "sim/setup/setup.hpp"
#include "sim/solver/slide.hpp"

namespace thawslide::sim {

// Particle that joins a run; properties not listed here are those at t = 0.
template <int Dim>
struct NewParticle {
  std::int32_t body = 0, material = 0;                     // numbers, as in Model
  Vector<Real, Dim> position = Vector<Real, Dim>::Zero();  // relative to the domain's lower corner [m]
  Vector<Real, Dim> velocity = Vector<Real, Dim>::Zero();  // [m/s]
  Real volume = 0;                                         // [m3], per metre of width in 2D
  Real temperature = 0, porosity = 0;                      // [C], [1]
  Real flow_depth = 0;                                     // below the surface, normal to the ground [m]: loads the ice
  SymmetricTensor<Real> stress = SymmetricTensor<Real>::Zero();  // total [Pa]
  Real heat = 0;  // in addition to the heat content at its temperature [J]: it warms or melts the particle
};

// Appends them with new ids, with mass and heat content. They are in no band until the next step. Returns the index in
// memory of the first.
template <int Dim>
std::size_t append_particles(const std::vector<NewParticle<Dim>>& joining, const Model<Dim>& model, Slide<Dim>& slide);

}  // namespace thawslide::sim
