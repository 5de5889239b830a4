// What passes over particles (mpm/particle_pass.hpp) know of the ground: its record, fetched like those of nodes, and
// which particles see candidate nodes.
#pragma once

#include <array>
#include <type_traits>

#include "terrain/ground_on_grid.hpp"
#include "terrain/near_ground_kernel.hpp"

namespace thawslide::terrain {

// The planes of nodes, made of what the ground is at nodes.
template <int Dim, class Real>
struct PlanesOfGround {
  using Record = std::array<Real, mpm::record_size(mpm::components_of<mpm::Planes, Dim>)>;

  static Record record_of(const GroundAtNode<Dim, Real>& known) {
    Record record{known.plane};
    mpm::set_vector<Dim>(record, mpm::Planes::normal, known.normal);
    return record;
  }
  [[nodiscard]] Record operator()(const mpm::NodeAt& at) const { return record_of(ground.block(at.block)[at.node]); }

  const GroundOnGrid<Dim, Real>& ground;
};

template <int Dim, class Real>
void load_patch(const mpm::SparseGrid<Dim, Real>& grid, std::size_t t, const PlanesOfGround<Dim, Real>& records,
                mpm::PatchOf<mpm::Planes, Dim, Real>& patch) {
  const std::int32_t* blocks = grid.blocks_about_tile(t);
  mpm::for_each_direction<Dim>([&](auto d) {
    const auto& block = records.ground.block(static_cast<std::size_t>(blocks[d]));
    mpm::for_shared_nodes<Dim, d>(
        [&](std::size_t in_block, std::size_t in_patch) {
          patch.records[in_patch] = PlanesOfGround<Dim, Real>::record_of(block[in_block]);
        },
        grid.rows_seen(t));
  });
}

// The records of a pass that reads of the ground.
template <int Dim, class Real>
struct NodesOnGround {
  mpm::Nodes<Dim, Real>& nodes;
  const GroundOnGrid<Dim, Real>& ground;

  template <class Name>
  [[nodiscard]] decltype(auto) of() const {
    if constexpr (std::is_same_v<Name, mpm::Planes>) {
      return PlanesOfGround<Dim, Real>{ground};
    } else {
      return nodes.template of<Name>();
    }
  }
};

// The tiles, and of these the batches and particles, that see candidate nodes with any shape functions.
template <int Dim, class Real>
struct SeesCandidates {
  const GroundOnGrid<Dim, Real>& ground;

  [[nodiscard]] bool operator()(std::size_t tile) const { return ground.any_near(tile); }
  // By the nodes of a batch, or the place of the lowest node of a particle.
  template <class Nodes>
  [[nodiscard]] bool operator()(std::size_t tile, const Nodes& nodes) const {
    return ground.any_near(tile, nodes);
  }
};

}  // namespace thawslide::terrain
