// What batches are to lanes, for one particle: what it carries, its weights, its place in a tile, and what it adds to a
// node.
#pragma once

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <type_traits>
#include <vector>

#include "mpm/particle_pass.hpp"

namespace thawslide::mpm {

// What one particle carries to a record: see Contribution.
template <class Real, int Dim, std::size_t Components>
struct OneContribution {
  static constexpr std::size_t width = Contribution<Dim, Real, Components>::width;
  static constexpr std::size_t size = record_size(static_cast<int>(Components));

  Real value[size] = {};
  Real flux[Dim][width] = {};

  // As shared memory is before anything is in it.
  void fill(Real number) {
    std::fill(std::begin(value), std::end(value), number);
    for (auto& along : flux) {
      std::fill(std::begin(along), std::end(along), number);
    }
  }
};

// The same of what it lowers.
template <class Real, std::size_t Count>
struct OneBounds : Bounds<Real, Count> {
  static constexpr std::size_t size = Count;

  void fill(Real number) { std::fill(std::begin(this->value), std::end(this->value), number); }
};

template <class Name, int Dim, class Real>
using CarriedByOne = std::conditional_t<IsLowered<Name>, OneBounds<Real, Adding<Name, Dim, Real>::carried>,
                                        OneContribution<Real, Dim, Adding<Name, Dim, Real>::carried>>;

// The weights of one particle: by axis, and the place in the patch of the lowest node that it sees.
template <class Real, int Dim, std::size_t Width>
struct OneStencil {
  std::array<AxisWeights<Real, Width>, static_cast<std::size_t>(Dim)> axis;
  std::size_t first = 0;
  std::array<std::size_t, static_cast<std::size_t>(Dim)> in_cell{};  // of that node among the 3 an axis of its cell
};

// The weights of one particle; those of momentum and of APIC where the pass has them.
template <int Dim, class Real>
struct OneWeights {
  OneStencil<Real, Dim, 2> linear;
  OneStencil<Real, Dim, 3> momentum, affine;
  Vector<Real, Dim> moment;

  template <class Functions>
  [[nodiscard]] const auto& of() const {
    if constexpr (std::is_same_v<Functions, LinearFunctions>) {
      return linear;
    } else if constexpr (std::is_same_v<Functions, AffineFunctions>) {
      return affine;
    } else {
      return momentum;
    }
  }
  [[nodiscard]] const Vector<Real, Dim>& second_moment() const { return moment; }
};

// A particle of a tile: itself, its nearest node and its cell.
template <int Dim>
struct TileParticle {
  std::uint32_t particle;
  std::array<std::int32_t, static_cast<std::size_t>(Dim)> nearest;
  std::size_t first_node, cell;  // the lowest node of the cell in the patch; number of the cell in the tile
};

// Those that a pass takes.
template <int Dim, class Real, class Takes>
std::vector<TileParticle<Dim>> particles_of_tile(const SparseGrid<Dim, Real>& grid, std::size_t tile,
                                                 const Takes& takes) {
  std::vector<TileParticle<Dim>> all;
  for (const TileBatch<Dim, Real>& batch : grid.batches(tile)) {
    for (std::size_t lane = 0; lane < batch.count; ++lane) {
      TileParticle<Dim> one{batch.particle[lane], {}, static_cast<std::size_t>(batch.nodes.first[lane]), 0};
      if (!takes_nodes(takes, tile, one.first_node)) {
        continue;
      }
      for (std::size_t a = 0; a < Dim; ++a) {
        one.nearest[a] = batch.nearest[a][lane];
      }
      const bool goes_on = !all.empty() && all.back().first_node == one.first_node;
      one.cell = all.empty() ? 0 : all.back().cell + (goes_on ? 0 : 1);
      all.push_back(one);
    }
  }
  return all;
}

template <int Dim, class Real>
Vector<Real, Dim> offset_of(const SparseGrid<Dim, Real>& grid, const Particles<Dim, Real>& particles,
                            const TileParticle<Dim>& one) {
  Vector<Real, Dim> offset;
  for (int a = 0; a < Dim; ++a) {
    const auto nearest = static_cast<Real>(one.nearest[static_cast<std::size_t>(a)]);
    offset[a] = particles.position(one.particle, a) * grid.inverse_cell() - nearest;
  }
  return offset;
}

// The corners of the cell of nodes in which the particle lies.
template <int Dim, class Real>
OneStencil<Real, Dim, 2> linear_stencil(const SparseGrid<Dim, Real>& grid, const Vector<Real, Dim>& offset,
                                        std::size_t first_node) {
  OneStencil<Real, Dim, 2> stencil;
  stencil.first = first_node;
  for (std::size_t a = 0; a < Dim; ++a) {
    const Real along = offset[static_cast<int>(a)];
    const bool right = along >= Real(0);
    stencil.in_cell[a] = right ? 1 : 0;
    stencil.first += right ? static_cast<std::size_t>(power(Tile<Dim>::patch_edge, static_cast<int>(a))) : 0;
    stencil.axis[a] = {{right ? Real(1) - along : -along, right ? along : Real(1) + along},
                       {-grid.inverse_cell(), grid.inverse_cell()}};
  }
  return stencil;
}

template <int Dim>
bool at_side(const HeldSides<Dim>& sides, const TileParticle<Dim>& one, std::size_t axis) {
  return one.nearest[axis] == sides.lower[axis] || one.nearest[axis] == sides.upper[axis];
}

template <int Dim, class Real>
OneWeights<Dim, Real> weights_of(const LinearWeights& /*weights*/, const SparseGrid<Dim, Real>& grid,
                                 const Particles<Dim, Real>& particles, const TileParticle<Dim>& one) {
  OneWeights<Dim, Real> of_one;
  of_one.linear = linear_stencil(grid, offset_of(grid, particles, one), one.first_node);
  return of_one;
}
template <class Shape, int Dim, class Real>
OneWeights<Dim, Real> weights_of(const MomentumWeights<Shape, Dim, Real>& weights, const SparseGrid<Dim, Real>& grid,
                                 const Particles<Dim, Real>& particles, const TileParticle<Dim>& one) {
  OneWeights<Dim, Real> of_one = weights_of(LinearWeights{}, grid, particles, one);
  const Vector<Real, Dim> offset = offset_of(grid, particles, one);
  const HalfSize<Real> size = weights.sizes.of(particles, One<Real>{{one.particle}});
  of_one.momentum.first = one.first_node;
  for (std::size_t a = 0; a < Dim; ++a) {
    of_one.momentum.axis[a] =
        Shape::weights(offset[static_cast<int>(a)], size, at_side(weights.sides, one, a), grid.inverse_cell());
  }
  return of_one;
}
template <class Shape, int Dim, class Real>
OneWeights<Dim, Real> weights_of(const AffineWeights<Shape, Dim, Real>& weights, const SparseGrid<Dim, Real>& grid,
                                 const Particles<Dim, Real>& particles, const TileParticle<Dim>& one) {
  const MomentumWeights<Shape, Dim, Real>& of_momentum = weights;
  OneWeights<Dim, Real> of_one = weights_of(of_momentum, grid, particles, one);
  const Vector<Real, Dim> offset = offset_of(grid, particles, one);
  of_one.affine = of_one.momentum;
  for (std::size_t a = 0; a < Dim; ++a) {
    const Real along = offset[static_cast<int>(a)];
    const auto& axis = of_one.momentum.axis[a];
    of_one.affine.axis[a] = Shape::affine(axis, along, at_side(weights.sides, one, a), grid.inverse_cell());
    of_one.moment[static_cast<int>(a)] = second_moment(axis, along) * (grid.cell() * grid.cell());
  }
  return of_one;
}

// A node of a particle's cell, numbered along each axis, as the particle numbers those that it sees.
template <int Dim, class Real, std::size_t Width>
std::optional<std::array<std::size_t, static_cast<std::size_t>(Dim)>> in_stencil(
    const OneStencil<Real, Dim, Width>& stencil, const std::array<std::size_t, 3>& node) {
  std::array<std::size_t, static_cast<std::size_t>(Dim)> k{};
  for (std::size_t a = 0; a < Dim; ++a) {
    if (node[a] < stencil.in_cell[a] || node[a] >= stencil.in_cell[a] + Width) {
      return std::nullopt;
    }
    k[a] = node[a] - stencil.in_cell[a];
  }
  return k;
}

// Component c of such a node after the particle, `sum` before it.
template <int Dim, class Real, std::size_t Width, std::size_t Components>
Real add_particle(const OneStencil<Real, Dim, Width>& stencil, const std::array<std::size_t, 3>& node,
                  const OneContribution<Real, Dim, Components>& carried, bool has_flux, std::size_t c, Real sum) {
  const auto seen = in_stencil(stencil, node);
  if (!seen) {
    return sum;
  }
  const auto& k = *seen;
  const auto& axis = stencil.axis;
  const bool with_flux = has_flux && c < OneContribution<Real, Dim, Components>::width;
  Real in_layer = carried.value[c];
  Real along_0 = with_flux ? carried.flux[0][c] : Real(0), along_1 = with_flux ? carried.flux[1][c] : Real(0);
  if constexpr (Dim == 3) {
    in_layer *= axis[2].weight[k[2]];
    if (with_flux) {
      in_layer += axis[2].slope[k[2]] * carried.flux[2][c];
      along_0 *= axis[2].weight[k[2]];
      along_1 *= axis[2].weight[k[2]];
    }
  }
  Real in_row = axis[1].weight[k[1]] * in_layer;
  if (with_flux) {
    in_row += axis[1].slope[k[1]] * along_1;
  }
  const Real along = axis[1].weight[k[1]] * along_0;
  sum += axis[0].weight[k[0]] * in_row;
  if (with_flux) {
    sum += axis[0].slope[k[0]] * along;
  }
  return sum;
}
template <int Dim, class Real, std::size_t Width, std::size_t Count>
Real add_particle(const OneStencil<Real, Dim, Width>& stencil, const std::array<std::size_t, 3>& node,
                  const OneBounds<Real, Count>& carried, bool /*has_flux*/, std::size_t c, Real smallest) {
  const auto seen = in_stencil(stencil, node);
  if (!seen) {
    return smallest;
  }
  Real weight = Real(1);
  for (std::size_t a = 0; a < Dim; ++a) {
    weight *= stencil.axis[a].weight[(*seen)[a]];
  }
  return weight > round_off<Real> ? min(smallest, carried.value[c]) : smallest;
}

}  // namespace thawslide::mpm
