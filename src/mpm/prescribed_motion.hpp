// Motion prescribed at nodes by the faces of the domain and by moving rigid frames (Sec. 3.2). For host and device.
#pragma once

#include <cstddef>

#include "mpm/domain_faces.hpp"

namespace thawslide::mpm {

// Box that moves along one axis and prescribes that component of velocity at the nodes inside.
template <int Dim>
struct RigidFrame {
  Vector<double, Dim> lower, upper;  // at t = 0 [m], relative to the domain's lower corner
  int axis = 0;
  double velocity = 0;  // [m/s]

  // True if the boxes between two corners and of the frame overlap.
  [[nodiscard]] THAWSLIDE_HD bool meets(const Vector<double, Dim>& from, const Vector<double, Dim>& to,
                                        double time) const {
    for (int a = 0; a < Dim; ++a) {
      const double shift = a == axis ? velocity * time : 0.0;
      if (!(to[a] - shift >= lower[a] && from[a] - shift <= upper[a])) {
        return false;
      }
    }
    return true;
  }
};

template <int Dim>
struct PrescribedMotion {
  DomainFaces<Dim> faces;
  const RigidFrame<Dim>* frames = nullptr;
  std::size_t frame_count = 0;

  // True if apply may set a component at positions between two corners.
  [[nodiscard]] THAWSLIDE_HD bool may_apply(const Vector<double, Dim>& lower, const Vector<double, Dim>& upper,
                                            double time) const {
    bool found = faces.meet(lower, upper);
    for (std::size_t k = 0; k < frame_count && !found; ++k) {
      found = frames[k].meets(lower, upper, time);
    }
    return found;
  }
  // Sets the prescribed components of a node's momentum; true if a frame has set one.
  THAWSLIDE_HD bool apply(const Vector<double, Dim>& position, double mass, double time,
                          Vector<double, Dim>& momentum) const {
    faces.apply_faces(position, momentum);
    bool in_frame = false;
    for (std::size_t k = 0; k < frame_count; ++k) {
      if (frames[k].meets(position, position, time)) {
        momentum[frames[k].axis] = mass * frames[k].velocity;
        in_frame = true;
      }
    }
    return in_frame;
  }
};

// Constraints on one node in a step.
template <int Dim>
struct NodeConstraints {
  const PrescribedMotion<Dim>& motion;
  Vector<double, Dim> position;  // [m]
  double time;                   // [s]
  bool held;                     // the node belongs to a held body, which is fixed
  bool may_apply;                // off: no motion is prescribed near the node, and the position is not used

  [[nodiscard]] THAWSLIDE_HD bool any() const { return held || may_apply; }
  [[nodiscard]] THAWSLIDE_HD bool is_held() const { return held; }
  // Sets the prescribed components of the node's momentum; true if a frame has set one.
  THAWSLIDE_HD bool apply(double mass, Vector<double, Dim>& momentum) const {
    if (held) {
      momentum.setZero();
      return false;
    }
    return may_apply && motion.apply(position, mass, time, momentum);
  }
};

}  // namespace thawslide::mpm
