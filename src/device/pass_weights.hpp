// Shape function weights between a particle and nodes, one particle per thread: scalar counterpart of the weights in
// mpm/particle_pass.hpp.
#pragma once

#include <array>

#include "mpm/body_sizes.hpp"
#include "mpm/one_particle.hpp"

namespace thawslide::device {

// Linear shape functions for all records of the pass.
struct LinearWeights {
  template <int Dim>
  [[nodiscard]] THAWSLIDE_HD static bool at_side(std::size_t /*axis*/, int /*node*/) {
    return false;
  }
  template <int Dim, class Particles>
  THAWSLIDE_HD void set(mpm::OneWeights<Dim>& weights, const mpm::OnePlace<Dim>& place, const Particles& /*particles*/,
                        const mpm::ScalarIndex& /*at*/, Real /*cell*/, Real inverse_cell) const {
    weights.set_linear(place, inverse_cell);
  }
};

// Shape: shape functions of momentum. sizes: of particles, in cells, in device memory.
template <class Shape, int Dim>
struct MomentumWeights {
  mpm::SizesOfBodies sizes;
  mpm::HeldSides<Dim> sides;

  template <int>
  [[nodiscard]] THAWSLIDE_HD bool at_side(std::size_t axis, int node) const {
    return node == sides.lower[axis] || node == sides.upper[axis];
  }
  template <class Particles>
  THAWSLIDE_HD void set(mpm::OneWeights<Dim>& weights, const mpm::OnePlace<Dim>& place, const Particles& particles,
                        const mpm::ScalarIndex& at, Real /*cell*/, Real inverse_cell) const {
    weights.set_linear(place, inverse_cell);
    weights.template set_momentum<Shape>(place, sizes.of(particles, at), inverse_cell);
  }
};

// Adds the weights of APIC.
template <class Shape, int Dim>
struct AffineWeights : MomentumWeights<Shape, Dim> {
  template <class Particles>
  THAWSLIDE_HD void set(mpm::OneWeights<Dim>& weights, const mpm::OnePlace<Dim>& place, const Particles& particles,
                        const mpm::ScalarIndex& at, Real cell, Real inverse_cell) const {
    MomentumWeights<Shape, Dim>::set(weights, place, particles, at, cell, inverse_cell);
    weights.template set_affine<Shape>(place, cell, inverse_cell);
  }
};

}  // namespace thawslide::device
