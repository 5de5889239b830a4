// The ground's normal impulse on the nodes of the grid (impulse_on_ground.hpp).
#pragma once

#include "mpm/nodes.hpp"
#include "terrain/ground_on_grid.hpp"
#include "terrain/impulse_on_ground.hpp"

namespace thawslide::terrain {

// q [kg m/s] of candidate node k of block b, which has mass. momentum_of(block, node): of nodes with mass [kg m/s].
template <int Dim, class Real, class MomentumOf>
Real normal_impulse_at(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
                       const mpm::Nodes<Dim, Real>& nodes, bool distance_check, Real dt, std::size_t b, std::size_t k,
                       const MomentumOf& momentum_of) {
  const auto block_of = [&](int direction) { return grid.blocks_about_block(b)[direction]; };
  const auto share =
      share_of_impulse(k, ground.block(b)[k], [&](int direction, int local) -> const GroundAtNode<Dim, Real>* {
        const std::int32_t block = block_of(direction);
        return block == KeyIndex::absent
                   ? nullptr
                   : &ground.block(static_cast<std::size_t>(block))[static_cast<std::size_t>(local)];
      });
  const auto impact = [&](std::size_t block, std::size_t node) {
    ImpactOfNode<Real> found;
    found.mass = nodes.momentum(block, node)[mpm::MomentumLayout<Dim>::mass];
    if (found.mass > Real(0)) {
      found.inward_momentum = momentum_of(block, node).dot(ground.block(block)[node].normal);
      found.clearance = nodes.near_ground(block, node)[mpm::NearGround::clearance];
    }
    return found;
  };
  const auto other = share.other > Real(0) ? impact(static_cast<std::size_t>(block_of(share.where.direction)),
                                                    static_cast<std::size_t>(share.where.local))
                                           : ImpactOfNode<Real>{};
  return normal_impulse(share, distance_check, dt, impact(b, k), other);
}

}  // namespace thawslide::terrain
