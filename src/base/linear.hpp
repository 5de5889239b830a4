// Small fixed-size vectors and matrices (Eigen), named as the rest of the code uses them.
#pragma once

// g++ leaves some of Eigen's small functions out of line, at the price of passing matrices through memory.
#define EIGEN_STRONG_INLINE inline __attribute__((always_inline))
#include <Eigen/Dense>

namespace thawslide {

template <class Real, int Dim>
using Vector = Eigen::Matrix<Real, Dim, 1>;

template <class Real, int Dim>
using Matrix = Eigen::Matrix<Real, Dim, Dim>;

// A symmetric tensor in three dimensions, components xx yy zz xy yz xz. Plane strain uses it whole, with yz = xz = 0,
// so that the out-of-plane stress is a full component. Shear components are tensor components, not engineering strains.
template <class Real>
using SymmetricTensor = Eigen::Matrix<Real, 6, 1>;

}  // namespace thawslide
