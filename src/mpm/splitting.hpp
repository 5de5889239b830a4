// Splitting of particles that have been stretched along the ground. A particle has the length 2 l_p along each
// horizontal axis at t = 0. In coordinates that follow the ground (mpm/mapping.hpp), its deformation in the horizontal
// plane at constant zeta is F, with
//   F <- (I + dt G_s) F,   (G_s)_ab = G_ab + G_az dB/dx_b,   a, b horizontal, G_ab = dv_a/dx_b.
// Its principal stretches are the roots of the eigenvalues of F F^T, along the eigenvectors. A particle whose length
// along the larger one passes a limit is split across it: its halves are at a quarter of that length from its centre on
// either side, and their stretch along that axis is half.
#pragma once

#include <cmath>

#include "base/linear.hpp"
#include "base/portability.hpp"
#include "physics/principal.hpp"

namespace thawslide::mpm {

// Length beyond which a particle is split, in cells. With 1 in place of 1.5 there are twice as many particles and no
// smaller gaps, and deposits grow by 1 to 2 % (docs/theory/momentum.md).
inline constexpr double longest_in_cells = 1.5;

// Volume, over the initial one, above which a particle is not split: tension has torn it, and its halves would keep on
// opening. Their low density would shorten the steps.
inline constexpr double torn_volume = 1.5;

template <int Dim>
using SurfaceStretch = Matrix<double, Dim - 1>;

// Updates F. gradient: of the displacement of the step in space, dt G.
template <int Dim, class Particles, class At, class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void update_surface_stretch(Particles& particles, const At& at,
                                                                 const Matrix<Value, Dim>& gradient) {
  constexpr int axes = Dim - 1;
  Matrix<Value, axes> along, stretch;
  for (int b = 0; b < axes; ++b) {
    const Value slope = particles.ground_slope.load(at, b);
    for (int a = 0; a < axes; ++a) {
      along(a, b) = gradient(a, b) + gradient(a, axes) * slope;
      stretch(a, b) = particles.surface_stretch.load(at, b * axes + a);
    }
  }
  const Matrix<Value, axes> change = along * stretch;
  for (int b = 0; b < axes; ++b) {
    for (int a = 0; a < axes; ++a) {
      particles.surface_stretch.store(at, stretch(a, b) + change(a, b), b * axes + a);
    }
  }
}

template <int Dim, class Particles>
SurfaceStretch<Dim> surface_stretch_of(const Particles& particles, std::size_t particle) {
  constexpr int axes = Dim - 1;
  SurfaceStretch<Dim> stretch;
  for (int b = 0; b < axes; ++b) {
    for (int a = 0; a < axes; ++a) {
      stretch(a, b) = particles.surface_stretch(particle, b * axes + a);
    }
  }
  return stretch;
}
template <int Dim, class Particles>
void set_surface_stretch(Particles& particles, std::size_t particle, const SurfaceStretch<Dim>& stretch) {
  constexpr int axes = Dim - 1;
  for (int b = 0; b < axes; ++b) {
    for (int a = 0; a < axes; ++a) {
      particles.surface_stretch(particle, b * axes + a) = stretch(a, b);
    }
  }
}

// Larger principal stretch, and the unit vector along it.
template <int Dim>
struct LongestAxis {
  double stretch;
  Vector<double, Dim - 1> direction;
};
template <int Dim>
LongestAxis<Dim> longest_axis(const SurfaceStretch<Dim>& stretch) {
  LongestAxis<Dim> axis;
  if constexpr (Dim == 2) {
    axis.stretch = std::abs(stretch(0, 0));
    axis.direction[0] = 1.0;
  } else {
    const double xx = stretch.row(0).squaredNorm(), yy = stretch.row(1).squaredNorm();
    const physics::detail::PlaneAxis<double> plane(xx, yy, stretch.row(0).dot(stretch.row(1)));
    axis.stretch = std::sqrt(0.5 * (xx + yy) + plane.radius);
    axis.direction = {plane.cosine, plane.sine};
  }
  return axis;
}

// F after halving along a unit vector.
template <int Dim>
SurfaceStretch<Dim> halved(const SurfaceStretch<Dim>& stretch, const Vector<double, Dim - 1>& direction) {
  return stretch - 0.5 * direction * (direction.transpose() * stretch);
}

// half_size: l_p in cells.
inline bool is_too_long(double stretch, double half_size) { return stretch * (2.0 * half_size) > longest_in_cells; }

}  // namespace thawslide::mpm
