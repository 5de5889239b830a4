// Objective strain and rotation of a step (Hughes and Winget 1980). With G the gradient of the step's displacement on
// the old configuration, the gradient on the middle configuration is
//   H = G (I + G/2)^-1,  strain = (H + H^T)/2,  spin W = (H - H^T)/2,  rotation Q = (I - W/2)^-1 (I + W/2)
// A rigid rotation gives zero strain and an exactly orthogonal Q; the volume changes by det(I + G).
#pragma once

#include "base/linear.hpp"
#include "base/portability.hpp"

namespace thawslide::physics {

template <class Value, int Dim>
struct StrainIncrement {
  SymmetricTensor<Value> strain;
  Matrix<Value, Dim> rotation;
  Value volume_ratio;  // new volume over old volume
};

template <class Value, int Dim>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE StrainIncrement<Value, Dim> strain_increment(
    const Matrix<Value, Dim>& displacement_gradient) {
  using Square = Matrix<Value, Dim>;
  const Square identity = Square::Identity();
  const Square to_middle = identity + displacement_gradient / Value(2);
  const Square middle = displacement_gradient * to_middle.inverse();
  const Square strain = (middle + middle.transpose()) / Value(2);
  const Square half_spin = (middle - middle.transpose()) / Value(4);
  StrainIncrement<Value, Dim> increment;
  increment.strain[0] = strain(0, 0);
  increment.strain[1] = strain(1, 1);
  increment.strain[2] = Dim == 3 ? strain(Dim - 1, Dim - 1) : Value(0);
  increment.strain[3] = strain(0, 1);
  increment.strain[4] = Dim == 3 ? strain(1, Dim - 1) : Value(0);
  increment.strain[5] = Dim == 3 ? strain(0, Dim - 1) : Value(0);
  // (I - S)^-1 (I + S) of a skew S in closed form (Cayley): |s|^2 = S:S/2
  const Value turn = Value(2) / (Value(1) + Value(0.5) * half_spin.squaredNorm());
  increment.rotation = identity + turn * (half_spin + half_spin * half_spin);
  increment.volume_ratio = (identity + displacement_gradient).determinant();
  return increment;
}

// Q s Q^T; in 2D, zz is unchanged.
template <class Value, int Dim>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE SymmetricTensor<Value> rotate(const SymmetricTensor<Value>& tensor,
                                                                   const Matrix<Value, Dim>& rotation) {
  SymmetricTensor<Value> rotated = tensor;
  if constexpr (Dim == 2) {
    Matrix<Value, 2> plane;
    plane << tensor[0], tensor[3], tensor[3], tensor[1];
    const Matrix<Value, 2> turned = rotation * plane * rotation.transpose();
    rotated[0] = turned(0, 0);
    rotated[1] = turned(1, 1);
    rotated[3] = turned(0, 1);
  } else {
    Matrix<Value, 3> full;
    full << tensor[0], tensor[3], tensor[5], tensor[3], tensor[1], tensor[4], tensor[5], tensor[4], tensor[2];
    const Matrix<Value, 3> turned = rotation * full * rotation.transpose();
    rotated << turned(0, 0), turned(1, 1), turned(2, 2), turned(0, 1), turned(1, 2), turned(0, 2);
  }
  return rotated;
}

}  // namespace thawslide::physics
