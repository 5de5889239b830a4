// Mapping between space and the coordinates of the background grid. Without ground, both are the same. With ground, the
// cells follow it: their vertical coordinate is the height above it,
//   zeta = z - B(x),   B = sum_i S_i(x) b_i,
// with the heights b_i of the columns of nodes and the horizontal shape functions S_i of the particle. Nodes are at
// (x_i, b_i + zeta_k), and the weights sum_i S_i(x) sum_k S_k(zeta) reproduce linear functions of space:
//   d/dx = d/dx at constant zeta - (dB/dx) d/dzeta,   d/dz = d/dzeta,   dB/dx = sum_i (dS_i/dx) b_i.
// The linear shape functions of temperature and pore pressure use dB/dx of their own derivatives. The determinant is 1,
// therefore volumes and masses need no factor. terrain/column_heights.hpp sets zeta and dB/dx. For host and device.
#pragma once

#include "base/linear.hpp"
#include "base/portability.hpp"
#include "mpm/reading.hpp"
#include "mpm/records.hpp"

namespace thawslide::mpm {

struct Mapping {
  bool has_ground = false;

  // Coordinate of particles along an axis of the grid [m].
  template <int Dim, class Particles, class At>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE auto coordinate(const Particles& particles, const At& at,
                                                                     int axis) const {
    return has_ground && axis == Dim - 1 ? particles.height_above_ground.load(at) : particles.position.load(at, axis);
  }
};

// Inverse of the thickness [1/m] of a layer of cells at particles, along its normal.
template <int Dim, class Particles, class At>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE typename At::Value inverse_layer(const Particles& particles, const At& at,
                                                                      double inverse_cell) {
  using Value = typename At::Value;
  if (!particles.linear_slope.is_kept()) {
    return Value(inverse_cell);
  }
  const auto slope = particles.linear_slope.template load_vector<Dim - 1>(at);
  return sqrt(Value(1.0) + slope.squaredNorm()) * inverse_cell;
}

// Mapping at a particle, or at the particles of a batch. slope: of the ground, by the shape functions of a record.
template <int Dim, class Value>
class MappingAt {
 public:
  template <class Slope, class At>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE MappingAt(const Mapping& mapping, const Slope& slope, const At& at)
      : has_ground_(mapping.has_ground) {
    if (has_ground_) {
      for (int a = 0; a + 1 < Dim; ++a) {
        slope_[a] = slope.load(at, a);
      }
    }
  }

  // Gradients on the grid to gradients in space.
  template <std::size_t Count>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Reading<Dim, Value, Count> in_space(Reading<Dim, Value, Count> reading) const {
    if (has_ground_) {
      unrolled<Count>([&](auto c) THAWSLIDE_INLINE_LAMBDA {
        for (int a = 0; a + 1 < Dim; ++a) {
          reading.gradient[static_cast<std::size_t>(a)][c] -= slope_[a] * reading.gradient[Dim - 1][c];
        }
      });
    }
    return reading;
  }
  // Fluxes in space to the fluxes that gradients on the grid multiply.
  template <class Carried>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void to_grid(Carried& carried) const {
    if (has_ground_) {
      unrolled<Carried::width>([&](auto c) THAWSLIDE_INLINE_LAMBDA {
        for (int a = 0; a + 1 < Dim; ++a) {
          carried.flux[Dim - 1][c] -= slope_[a] * carried.flux[a][c];
        }
      });
    }
  }
  // Gradients of a vector in space, d v_a / d x_b, to gradients on the grid.
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Matrix<Value, Dim> on_grid(Matrix<Value, Dim> gradient) const {
    if (has_ground_) {
      for (int a = 0; a + 1 < Dim; ++a) {
        gradient.col(a) += gradient.col(Dim - 1) * slope_[a];
      }
    }
    return gradient;
  }

 private:
  bool has_ground_;
  Vector<Value, Dim - 1> slope_;  // dB/dx, only with ground
};

// Maps the fluxes of a contribution to a record. The kernels of APIC map theirs themselves.
template <class Name, class Weights, class Carried>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void map_fluxes([[maybe_unused]] const Weights& weights,
                                                     [[maybe_unused]] Carried& carried) {
  if constexpr (!IsMinReduced<Name> && !std::is_same_v<typename Name::Functions, AffineFunctions>) {
    if constexpr (Name::flux != no_flux) {
      weights.template mapping_of<typename Name::Functions>().to_grid(carried);
    }
  }
}

}  // namespace thawslide::mpm
