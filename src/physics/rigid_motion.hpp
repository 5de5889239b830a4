// Least-squares fit of a rigid motion to velocities v_k at positions x_k with masses m_k (a chapter on rigid bodies of
// any textbook of mechanics): the motion of a rigid body with the same momentum and angular momentum.
//   v(x) = u + w x (x - c),  m = sum m_k,  m c = sum m_k x_k,  m u = sum m_k v_k
//   I w = sum m_k x_k x v_k - m c x u,  I = sum m_k [|x_k - c|^2 1 - (x_k - c)(x_k - c)^T]
// In 2D, rotation, moment and I are one number each. All positions are relative to a common origin.
#pragma once

#include "base/linear.hpp"
#include "base/portability.hpp"
#include "physics/principal.hpp"

namespace thawslide::physics {

// Components of a rotation or moment, and of the products of a position with itself: |x|^2, or x x^T (xx yy zz xy yz
// xz).
template <int Dim>
inline constexpr int rotations = Dim == 2 ? 1 : 3;
template <int Dim>
inline constexpr int squares = Dim == 2 ? 1 : 6;

// x x v.
template <int Dim, class Value>
[[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Vector<Value, rotations<Dim>> moment_of(
    const Vector<Value, Dim>& position, const Vector<Value, Dim>& velocity) {
  Vector<Value, rotations<Dim>> moment;
  if constexpr (Dim == 2) {
    moment[0] = position[0] * velocity[1] - position[1] * velocity[0];
  } else {
    moment[0] = position[1] * velocity[2] - position[2] * velocity[1];
    moment[1] = position[2] * velocity[0] - position[0] * velocity[2];
    moment[2] = position[0] * velocity[1] - position[1] * velocity[0];
  }
  return moment;
}

// w x x: velocity [m/s] at a position by a rotation w [1/s].
template <int Dim, class Value>
[[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Vector<Value, Dim> turned(
    const Vector<Value, rotations<Dim>>& rotation, const Vector<Value, Dim>& position) {
  Vector<Value, Dim> velocity;
  if constexpr (Dim == 2) {
    velocity[0] = -rotation[0] * position[1];
    velocity[1] = rotation[0] * position[0];
  } else {
    velocity = moment_of<Dim>(rotation, position);
  }
  return velocity;
}

// Products of a position with itself [m2].
template <int Dim, class Value>
[[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Vector<Value, squares<Dim>> squares_of(
    const Vector<Value, Dim>& position) {
  Vector<Value, squares<Dim>> products;
  if constexpr (Dim == 2) {
    products[0] = position[0] * position[0] + position[1] * position[1];
  } else {
    products[0] = position[0] * position[0];
    products[1] = position[1] * position[1];
    products[2] = position[2] * position[2];
    products[3] = position[0] * position[1];
    products[4] = position[1] * position[2];
    products[5] = position[0] * position[2];
  }
  return products;
}

// Sums over mass points.
template <int Dim>
struct MassPoints {
  double mass;                            // [kg]
  Vector<double, Dim> first;              // sum m x [kg m]
  Vector<double, squares<Dim>> second;    // sum m x x [kg m2]
  Vector<double, Dim> momentum;           // sum m v [kg m/s]
  Vector<double, rotations<Dim>> moment;  // sum m x x v [kg m2/s]
};

template <int Dim>
struct RigidMotion {
  Vector<double, Dim> at_origin = Vector<double, Dim>::Zero();                       // v(0) [m/s]
  Vector<double, rotations<Dim>> rotation = Vector<double, rotations<Dim>>::Zero();  // w [1/s]
};

// Rotation around an axis is ignored if the moment of inertia is at most mass times least_square [m2], for points too
// close to the axis.
template <int Dim>
[[nodiscard]] THAWSLIDE_HD RigidMotion<Dim> nearest_rigid_motion(const MassPoints<Dim>& points, double least_square) {
  const Vector<double, Dim> centre = points.first / points.mass, velocity = points.momentum / points.mass;
  const Vector<double, rotations<Dim>> spin = points.moment - moment_of<Dim>(centre, points.momentum);
  const Vector<double, squares<Dim>> about_centre = points.second - points.mass * squares_of<Dim>(centre);
  RigidMotion<Dim> motion;
  if constexpr (Dim == 2) {
    if (about_centre[0] > points.mass * least_square) {
      motion.rotation = spin / about_centre[0];
    }
  } else {
    const auto& s = about_centre;
    SymmetricTensor<double> inertia;
    inertia << s[1] + s[2], s[0] + s[2], s[0] + s[1], -s[3], -s[4], -s[5];
    const Principal<double> about = principal(inertia);
    for (int k = 0; k < 3; ++k) {
      if (about.values[k] > points.mass * least_square) {
        const Vector<double, 3> axis = about.axes.col(k);
        motion.rotation += axis.dot(spin) / about.values[k] * axis;
      }
    }
  }
  motion.at_origin = velocity - turned<Dim>(motion.rotation, centre);
  return motion;
}

}  // namespace thawslide::physics
