// Prescribed motion at nodes: boundaries of the domain (fixed, roller, open) and rigid frames that move (Sec. 3.2).
#pragma once

#include <vector>

#include "base/linear.hpp"
#include "base/portability.hpp"

namespace thawslide::mpm {

enum class FaceKind { open, roller, fixed };

// A box that moves with a velocity along one axis and prescribes that component of velocity at the nodes within.
template <int Dim, class Real>
struct RigidFrame {
  Vector<Real, Dim> lower, upper;  // at t = 0 [m], relative to the domain's lower corner
  int axis = 0;
  Real velocity = 0;  // [m/s]
};

template <int Dim, class Real>
struct Constraints {
  Vector<Real, Dim> extent;      // upper corner of the domain [m]; the lower corner is the origin
  FaceKind faces[2 * Dim] = {};  // lower and upper face of each axis
  std::vector<RigidFrame<Dim, Real>> frames;

  // Sets the prescribed components of a node's momentum; true if any was set by a frame.
  bool apply(const Vector<Real, Dim>& position, Real mass, Real time, Vector<Real, Dim>& momentum) const {
    apply_faces(position, momentum);
    bool in_frame = false;
    for (const RigidFrame<Dim, Real>& frame : frames) {
      Vector<Real, Dim> place = position;
      place[frame.axis] -= frame.velocity * time;
      if ((place.array() >= frame.lower.array()).all() && (place.array() <= frame.upper.array()).all()) {
        momentum[frame.axis] = mass * frame.velocity;
        in_frame = true;
      }
    }
    return in_frame;
  }

 private:
  void apply_faces(const Vector<Real, Dim>& position, Vector<Real, Dim>& momentum) const {
    for (int a = 0; a < Dim; ++a) {
      const bool at_lower = position[a] <= round_off<Real> * extent[a];
      const bool at_upper = position[a] >= extent[a] * (Real(1) - round_off<Real>);
      const FaceKind kind = at_lower ? faces[2 * a] : at_upper ? faces[2 * a + 1] : FaceKind::open;
      if (kind == FaceKind::fixed) {
        momentum.setZero();
      } else if (kind == FaceKind::roller) {
        momentum[a] = Real(0);
      }
    }
  }
};

}  // namespace thawslide::mpm
