// The particles of a tile one by one, as the host's groups take them (mpm/group_pass.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "mpm/one_particle.hpp"
#include "mpm/particle_pass.hpp"

namespace thawslide::mpm {

// What one carries to a record, or brings to one that it lowers.
template <class Name, int Dim, class Real>
using CarriedByOne = std::conditional_t<IsLowered<Name>, OneBounds<Real, Adding<Name, Dim, Real>::carried>,
                                        OneContribution<Real, Dim, Adding<Name, Dim, Real>::carried>>;

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
OnePlace<Dim, Real> place_of(const SparseGrid<Dim, Real>& grid, const HeldSides<Dim>& sides,
                             const Particles<Dim, Real>& particles, const TileParticle<Dim>& one) {
  OnePlace<Dim, Real> place{{}, one.first_node, {}};
  for (std::size_t a = 0; a < Dim; ++a) {
    const int axis = static_cast<int>(a);
    place.offset[axis] =
        particles.position(one.particle, axis) * grid.inverse_cell() - static_cast<Real>(one.nearest[a]);
    place.at_side[a] = one.nearest[a] == sides.lower[a] || one.nearest[a] == sides.upper[a];
  }
  return place;
}

template <int Dim, class Real>
OneWeights<Dim, Real> weights_of(const LinearWeights& /*weights*/, const SparseGrid<Dim, Real>& grid,
                                 const Particles<Dim, Real>& particles, const TileParticle<Dim>& one) {
  OneWeights<Dim, Real> of_one;
  of_one.set_linear(place_of(grid, HeldSides<Dim>{}, particles, one), grid.inverse_cell());
  return of_one;
}
template <class Shape, int Dim, class Real>
OneWeights<Dim, Real> weights_of(const MomentumWeights<Shape, Dim, Real>& weights, const SparseGrid<Dim, Real>& grid,
                                 const Particles<Dim, Real>& particles, const TileParticle<Dim>& one) {
  OneWeights<Dim, Real> of_one;
  const OnePlace<Dim, Real> place = place_of(grid, weights.sides, particles, one);
  of_one.set_linear(place, grid.inverse_cell());
  const HalfSize<Real> size = weights.sizes.of(particles, One<Real>{{one.particle}});
  of_one.template set_momentum<Shape>(place, size, grid.inverse_cell());
  return of_one;
}
template <class Shape, int Dim, class Real>
OneWeights<Dim, Real> weights_of(const AffineWeights<Shape, Dim, Real>& weights, const SparseGrid<Dim, Real>& grid,
                                 const Particles<Dim, Real>& particles, const TileParticle<Dim>& one) {
  const MomentumWeights<Shape, Dim, Real>& of_momentum = weights;
  OneWeights<Dim, Real> of_one = weights_of(of_momentum, grid, particles, one);
  of_one.template set_affine<Shape>(place_of(grid, weights.sides, particles, one), grid.cell(), grid.inverse_cell());
  return of_one;
}

}  // namespace thawslide::mpm
