// A piece of the slide's base, which carries a band column (physics/band_column.hpp) and moves with the slide.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "base/linear.hpp"
#include "mpm/sparse_grid.hpp"
#include "physics/band_column.hpp"

namespace thawslide::band {

template <int Dim, class Real>
struct BasePiece {
  using Sides = Eigen::Matrix<Real, Dim, Dim - 1>;

  std::int64_t id = 0;
  Vector<Real, Dim> position;  // of its middle, on the ground [m]
  Vector<Real, Dim> normal;    // unit vector into the ground
  Sides sides;                 // its edges, along the ground [m]; of a 2D case one
  Real area = 0;               // [m2], per metre of width in 2D
  Real area_of_column = 0;     // the area that the column's numbers are per [m2]
  Real slip = 0;               // [m]
  Real speed = 0;              // of slip [m/s]
  Real load = 0;               // normal pressure N, averaged over time [Pa]
  Real heat = 0;               // friction heat since the column's last step [J/m2]
  bool touched = false;        // has ever carried load
  physics::BandColumn<Real> column;
};

template <int Dim, class Real>
Real area_of(const Eigen::Matrix<Real, Dim, Dim - 1>& sides) {
  if constexpr (Dim == 2) {
    return sides.norm();
  } else {
    return sides.col(0).cross(sides.col(1)).norm();
  }
}

// v as it is after the turn that takes the unit vector `from` to `to` by the shortest way.
template <int Dim, class Real>
Vector<Real, Dim> turned(const Vector<Real, Dim>& v, const Vector<Real, Dim>& from, const Vector<Real, Dim>& to) {
  const Vector<Real, Dim> both = from + to;
  const Real along = Real(1) + from.dot(to);
  return along > round_off<Real> ? Vector<Real, Dim>(v - both * (both.dot(v) / along) + Real(2) * from.dot(v) * to) : v;
}

// The nodes that a piece of base sees, with the weights of quadratic B-splines: they reach 1.5 cells along each axis,
// further than nodes which feel the slide lie from the ground.
template <int Dim, class Real>
struct BaseStencil {
  using T = mpm::Tile<Dim>;
  static constexpr std::size_t most = static_cast<std::size_t>(T::stencil);

  std::size_t count = 0;
  std::array<std::size_t, most> block, node;
  std::array<Real, most> weight;

  BaseStencil(const mpm::SparseGrid<Dim, Real>& grid, const Vector<Real, Dim>& position) {
    typename T::Index nearest, tile;
    std::array<std::array<Real, 3>, Dim> along;
    for (std::size_t a = 0; a < Dim; ++a) {
      const Real place = position[static_cast<int>(a)] * grid.inverse_cell();
      const Real node_place = std::floor(place + Real(0.5));
      const Real d = place - node_place;
      nearest[a] = static_cast<int>(node_place);
      along[a] = {Real(0.5) * (Real(0.5) - d) * (Real(0.5) - d), Real(0.75) - d * d,
                  Real(0.5) * (Real(0.5) + d) * (Real(0.5) + d)};
    }
    int local = 0;
    T::split(nearest, tile, local);
    const auto found = std::lower_bound(grid.blocks().begin(), grid.blocks().end(), T::key(tile));
    if (found == grid.blocks().end() || *found != T::key(tile)) {
      return;  // no slide is near
    }
    const std::int32_t* about = grid.blocks_about_block(static_cast<std::size_t>(found - grid.blocks().begin()));
    for (int k = 0; k < T::stencil; ++k) {
      int direction = T::stencil / 2, in_tile = local;
      Real product = 1;
      for (int a = 0, rest = k; a < Dim; ++a, rest /= 3) {
        const typename T::Beside beside = T::beside(in_tile, a, rest % 3 - 1);
        direction += beside.direction - T::stencil / 2;
        in_tile = beside.local;
        product *= along[static_cast<std::size_t>(a)][static_cast<std::size_t>(rest % 3)];
      }
      if (about[direction] != KeyIndex::absent && product > Real(0)) {
        block[count] = static_cast<std::size_t>(about[direction]);
        node[count] = static_cast<std::size_t>(in_tile);
        weight[count++] = product;
      }
    }
  }
};

}  // namespace thawslide::band
