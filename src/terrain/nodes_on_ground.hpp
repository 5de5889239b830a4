// Ground data for particle passes (mpm/particle_pass.hpp): its record, loaded like nodal records, and the filter for
// particles that reach candidate nodes.
#pragma once

#include <array>
#include <type_traits>

#include "terrain/ground_on_grid.hpp"
#include "terrain/near_ground_kernel.hpp"

namespace thawslide::terrain {

// Planes of nodes, from the ground at nodes.
template <int Dim>
struct PlanesOfGround {
  using Record = std::array<double, mpm::record_size(mpm::components_of<mpm::Planes, Dim>)>;

  static Record record_of(const GroundAtNode<Dim>& known) {
    Record record{known.plane};
    mpm::set_vector<Dim>(record, mpm::Planes::normal, known.plane_scale * known.normal);
    return record;
  }
  [[nodiscard]] Record operator()(const mpm::NodeAt& at) const { return record_of(ground.block(at.block)[at.node]); }

  const GroundOnGrid<Dim>& ground;
};

template <int Dim>
void load_patch(const mpm::SparseGrid<Dim>& grid, std::size_t t, const PlanesOfGround<Dim>& records,
                mpm::PatchOf<mpm::Planes, Dim>& patch) {
  const std::int32_t* blocks = grid.blocks_about_tile(t);
  mpm::for_each_direction<Dim>([&](auto d) {
    const auto& block = records.ground.block(static_cast<std::size_t>(blocks[d]));
    mpm::for_shared_nodes<Dim, d>(
        [&](std::size_t in_block, std::size_t in_patch) {
          patch.records[in_patch] = PlanesOfGround<Dim>::record_of(block[in_block]);
        },
        grid.rows_seen(t));
  });
}

// Records of a pass that reads ground data.
template <int Dim>
struct NodesOnGround {
  mpm::Nodes<Dim>& nodes;
  const GroundOnGrid<Dim>& ground;

  template <class Name>
  [[nodiscard]] decltype(auto) of() const {
    if constexpr (std::is_same_v<Name, mpm::Planes>) {
      return PlanesOfGround<Dim>{ground};
    } else {
      return nodes.template of<Name>();
    }
  }
};

// Filter for tiles, batches and particles that reach candidate nodes with any shape function.
template <int Dim>
struct SeesCandidates {
  const GroundOnGrid<Dim>& ground;

  [[nodiscard]] bool operator()(std::size_t tile) const { return ground.any_near(tile); }
  // nodes: of a batch, or the place of the lowest node of a particle.
  template <class Nodes>
  [[nodiscard]] bool operator()(std::size_t tile, const Nodes& nodes) const {
    return ground.any_near(tile, nodes);
  }
};

}  // namespace thawslide::terrain
