// Nodal part of filter_velocities, for one node. For host and device.
#pragma once

#include <cstddef>

#include "base/linear.hpp"
#include "mpm/kernel.hpp"
#include "mpm/records.hpp"
#include "mpm/vectors_in_records.hpp"
#include "physics/rigid_motion.hpp"

namespace thawslide::mpm {

// Mean square distance [m2] of mass from an axis below which rotation around it is ignored. cell: mesh size [m].
inline THAWSLIDE_HD double least_square_of(double cell) {
  constexpr double least = 1e-8;  // in cells squared
  return least * cell * cell;
}

// Next increment of a node's rigid motion from the particle sums: the fit itself, or the last increment minus the fit.
// Records: of Momentum, FilterMoments, FilterMomentum, FilterIncrement and FilterTotal.
template <int Dim, class MassRecord, class Moments, class Brought, class Increment, class Total>
THAWSLIDE_HD void make_increment(bool first, double least_square, const MassRecord& mass, const Moments& moments,
                                 const Brought& brought, Increment& increment, Total& total) {
  constexpr int turns = physics::rotations<Dim>, size = components_of<FilterMomentum, Dim>;
  if (first) {
    for (std::size_t c = 0; c < record_size(size); ++c) {
      increment[c] = total[c] = 0.0;
    }
  }
  if (!(mass[MomentumLayout<Dim>::mass] > 0.0)) {
    return;
  }
  const physics::MassPoints<Dim> points{mass[MomentumLayout<Dim>::mass], vector_at<Dim>(moments, FilterMoments::first),
                                        vector_at<physics::squares<Dim>>(moments, Dim),
                                        vector_at<Dim>(brought, FilterMomentum::momentum),
                                        vector_at<turns>(brought, Dim)};
  const physics::RigidMotion<Dim> motion = physics::nearest_rigid_motion(points, least_square);
  Vector<double, size> fit;
  fit << motion.at_origin, motion.rotation;
  const Vector<double, size> next = first ? fit : Vector<double, size>(vector_at<size>(increment, 0) - fit);
  set_vector<size>(increment, 0, next);
  set_vector<size>(total, 0, Vector<double, size>(vector_at<size>(total, 0) + next));
}

}  // namespace thawslide::mpm
