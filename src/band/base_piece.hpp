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
  // Of the slide about it along the ground, as it was at the column's last step [m/s].
  Vector<Real, Dim> velocity = Vector<Real, Dim>::Zero();
  Sides sides;              // its edges, along the ground [m]; of a 2D case one
  Real area = 0;            // [m2], per metre of width in 2D
  Real area_of_column = 0;  // the area that the column's numbers are per [m2]
  Real slip = 0;            // [m]
  Real speed = 0;           // of slip [m/s]
  Real load = 0;            // normal pressure N, averaged over time [Pa]
  Real depth = 0;           // of the slide above, along the normal, from what the piece bears, averaged [m]
  Real loaded_for = 0;      // how long the depth has been averaged [s]
  Real heat = 0;            // friction heat of its whole area since the column's last step [J]
  bool touched = false;     // has ever carried load
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

// The edges of a piece that seen from above is as long along each axis as `size`.
template <int Dim, class Real>
Eigen::Matrix<Real, Dim, Dim - 1> sides_on(const Vector<Real, Dim>& normal, const Vector<Real, Dim - 1>& size) {
  Eigen::Matrix<Real, Dim, Dim - 1> sides = Eigen::Matrix<Real, Dim, Dim - 1>::Zero();
  for (int a = 0; a + 1 < Dim; ++a) {
    sides(a, a) = size[a];
    sides(Dim - 1, a) = -normal[a] / normal[Dim - 1] * size[a];
  }
  return sides;
}

// v as it is after the turn that takes the unit vector `from` to `to` by the shortest way.
template <int Dim, class Real>
Vector<Real, Dim> turned(const Vector<Real, Dim>& v, const Vector<Real, Dim>& from, const Vector<Real, Dim>& to) {
  const Vector<Real, Dim> both = from + to;
  const Real along = Real(1) + from.dot(to);
  return along > round_off<Real> ? Vector<Real, Dim>(v - both * (both.dot(v) / along) + Real(2) * from.dot(v) * to) : v;
}

// The nodes that a piece of base sees, with the weights of cubic B-splines: they reach two cells along each axis. Nodes
// that feel the slide lie within 1.25 cells of the ground, and their feet within half a cell of where a piece is laid.
template <int Dim, class Real>
struct BaseStencil {
  using T = mpm::Tile<Dim>;
  static constexpr int width = 4;
  static constexpr std::size_t most = static_cast<std::size_t>(mpm::power(width, Dim));

  std::size_t count = 0;
  std::array<std::size_t, most> block, node;
  std::array<Real, most> weight;

  BaseStencil(const mpm::SparseGrid<Dim, Real>& grid, const Vector<Real, Dim>& position) {
    typename T::Index below, tile;
    std::array<std::array<Real, width>, Dim> along;
    for (std::size_t a = 0; a < Dim; ++a) {
      const Real place = position[static_cast<int>(a)] * grid.inverse_cell();
      below[a] = static_cast<int>(std::floor(place));
      along[a] = cubic_weights(place - std::floor(place));
    }
    int local = 0;
    T::split(below, tile, local);
    const auto found = std::lower_bound(grid.blocks().begin(), grid.blocks().end(), T::key(tile));
    if (found == grid.blocks().end() || *found != T::key(tile)) {
      return;  // no slide is near
    }
    const std::int32_t* about = grid.blocks_about_block(static_cast<std::size_t>(found - grid.blocks().begin()));
    for (int k = 0; k < static_cast<int>(most); ++k) {
      int direction = T::stencil / 2, in_tile = local;
      Real product = 1;
      for (int a = 0, rest = k; a < Dim; ++a, rest /= width) {
        const typename T::Beside beside = T::beside(in_tile, a, rest % width - 1);
        direction += beside.direction - T::stencil / 2;
        in_tile = beside.local;
        product *= along[static_cast<std::size_t>(a)][static_cast<std::size_t>(rest % width)];
      }
      if (about[direction] != KeyIndex::absent && product > Real(0)) {
        block[count] = static_cast<std::size_t>(about[direction]);
        node[count] = static_cast<std::size_t>(in_tile);
        weight[count++] = product;
      }
    }
  }

 private:
  // Of the two nodes on either side of a place at the share t between the inner ones.
  static std::array<Real, width> cubic_weights(Real t) {
    const Real s = Real(1) - t, sixth = Real(1) / Real(6);
    return {sixth * s * s * s, sixth * (Real(4) - Real(3) * t * t * (Real(2) - t)),
            sixth * (Real(4) - Real(3) * s * s * (Real(2) - s)), sixth * t * t * t};
  }
};

}  // namespace thawslide::band
