// Small fixed-size vectors and matrices (Eigen).
#pragma once

// g++ does not inline some of Eigen's small functions, which then pass matrices through memory.
#define EIGEN_STRONG_INLINE inline __attribute__((always_inline))
#include <Eigen/Dense>

namespace thawslide {

template <class Real, int Dim>
using Vector = Eigen::Matrix<Real, Dim, 1>;

template <class Real, int Dim>
using Matrix = Eigen::Matrix<Real, Dim, Dim>;

// Symmetric 3D tensor, components xx yy zz xy yz xz. Plane strain uses all of them, with yz = xz = 0, which includes
// the out-of-plane stress. Shear components are tensor components, not engineering strains.
template <class Real>
using SymmetricTensor = Eigen::Matrix<Real, 6, 1>;

}  // namespace thawslide
