// Small fixed-size vectors and matrices (Eigen).
#pragma once

// g++ does not inline some of Eigen's small functions, which then pass matrices through memory.
#define EIGEN_STRONG_INLINE inline __attribute__((always_inline))
#include <Eigen/Dense>

#include "base/portability.hpp"

namespace thawslide {

template <class T, int Dim>
using Vector = Eigen::Matrix<T, Dim, 1>;

template <class T, int Dim>
using Matrix = Eigen::Matrix<T, Dim, Dim>;

// Symmetric 3D tensor, components xx yy zz xy yz xz. Plane strain uses all of them, with yz = xz = 0, which includes
// the out-of-plane stress. Shear components are tensor components, not engineering strains.
template <class T>
using SymmetricTensor = Eigen::Matrix<T, 6, 1>;

}  // namespace thawslide
