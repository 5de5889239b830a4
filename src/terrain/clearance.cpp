#include "terrain/clearance.hpp"

#include <algorithm>
#include <limits>

#include "base/instances.hpp"
#include "mpm/batch_transfer.hpp"

namespace thawslide::terrain {

namespace {

// The ground about a tile: distance [m], and its normal.
template <int Dim, class Real>
using DistancePatch = mpm::Patch<Dim, Real, 1 + Dim>;

template <int Dim, class Real>
bool load_distances(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground, std::size_t t,
                    DistancePatch<Dim, Real>& patch) {
  const std::int32_t* blocks = grid.blocks_about_tile(t);
  bool any = false;
  mpm::for_each_direction<Dim>([&](auto d) {
    const auto b = static_cast<std::size_t>(blocks[d]);
    any = any || ground.any_candidate(b);
    mpm::for_shared_nodes<Dim, d>([&](std::size_t in_block, std::size_t in_patch) {
      const auto& known = ground.block(b)[in_block];
      patch.records[in_patch][0] = known.distance;
      mpm::set_vector<Dim>(patch.records[in_patch], 1, known.normal);
    });
  });
  return any;
}

// How far boxes of half size `half` [m] reach towards the ground if that lies along a grid axis; what they read of the
// patch.
template <int Dim, class Real>
Lanes<Real> reach_of_box(const mpm::Reading<Dim, Lanes<Real>, 1 + Dim>& seen, Lanes<Real> half) {
  using std::max, std::abs;
  Lanes<Real> largest = Real(0);
  for (std::size_t a = 0; a < Dim; ++a) {
    largest = max(largest, abs(seen.value[1 + a]));
  }
  return half * largest;
}

// Lowers the clearance of the nodes that particles see.
template <int Dim, class Real>
THAWSLIDE_ALWAYS_INLINE void lower_clearance(const mpm::BatchStencil<Dim, Real>& stencil, std::size_t count,
                                             Lanes<Real> clearance, mpm::Patch<Dim, Real, 1>& patch) {
  constexpr Real far = std::numeric_limits<Real>::max();
  mpm::for_each_node<Dim>(
      stencil.axis, 0, [&](std::size_t offset, Lanes<Real> weight, const Vector<Lanes<Real>, Dim>& /*slope*/) {
        const Lanes<Real> seen = select(weight > Real(0), clearance, Lanes<Real>(far));
        for (std::size_t lane = 0; lane < count; ++lane) {
          Real& known = patch.records[static_cast<std::size_t>(stencil.nodes.first[lane]) + offset][0];
          known = std::min(known, seen[lane]);
        }
      });
}

}  // namespace

template <int Dim, class Real>
void set_reach(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
               const std::vector<Real>& half_size, mpm::Particles<Dim, Real>& particles) {
  constexpr Real within_lowest_layer = Real(2) * (Real(1) + round_off<Real>);  // times a particle's reach
  DistancePatch<Dim, Real> patch;
  for (std::size_t t = 0; t < grid.tiles().size(); ++t) {
    const auto& tile = grid.tiles()[t];
    load_distances(grid, ground, t, patch);
    mpm::for_each_batch<Real>(grid.order(), tile.first, tile.last, [&](const mpm::Batch<Real>& batch) {
      const auto seen = mpm::read_nodes<1 + Dim>(hat_stencil(grid, tile.key, particles, batch), patch);
      const Lanes<Real> reach = reach_of_box(seen, of_body(half_size, particles, batch) * grid.cell());
      const auto lowest = seen.value[0] < within_lowest_layer * reach;
      particles.reach.store(batch, select(lowest, seen.value[0], reach));
    });
  }
}

template <int Dim, class Real>
void clearances_to_grid(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
                        mpm::ShapeKind shape, const std::vector<Real>& half_size, const mpm::HeldSides<Dim>& sides,
                        const mpm::Particles<Dim, Real>& particles, mpm::Nodes<Dim, Real>& nodes) {
  constexpr Real far = std::numeric_limits<Real>::max();
  // A contact node lies within sqrt(2) cells of the ground, and the nodes that a particle sees within 2 cells of one
  // another along every axis: no further away, by the hats, is a particle that sees a contact node.
  constexpr Real beyond_contact = 5;
  const auto patches = nodes.clearance.patches(grid.tiles().size());
  mpm::with_shape<Real>(shape, [&](auto shape_function) {
    parallel_for(grid.tiles().size(), [&](std::size_t t) {
      auto& patch = patches[t];
      patch.records.fill({far});
      DistancePatch<Dim, Real> distances;
      if (!load_distances(grid, ground, t, distances)) {
        return;
      }
      const auto& tile = grid.tiles()[t];
      mpm::for_each_batch<Real>(grid.order(), tile.first, tile.last, [&](const mpm::Batch<Real>& batch) {
        const auto hats = hat_stencil(grid, tile.key, particles, batch);
        const Lanes<Real> distance = mpm::read_nodes<1>(hats, distances).value[0];
        if (!any(distance < beyond_contact * grid.cell())) {
          return;
        }
        const Lanes<Real> clearance = max(Lanes<Real>(Real(0)), distance - particles.reach.load(batch));
        const auto place = place_of(grid, particles, batch);
        const auto stencil = mpm::make_stencil<decltype(shape_function)>(grid, tile.key, place,
                                                                         of_body(half_size, particles, batch), sides);
        lower_clearance(stencil, batch.count, clearance, patch);
      });
    });
  });
  nodes.clearance.resize(grid.blocks().size());
  parallel_for(grid.blocks().size(), [&](std::size_t b) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<Dim>::nodes); ++k) {
      nodes.clearance(b, k)[0] = far;
    }
    const std::int32_t* tiles = grid.tiles_about_block(b);
    mpm::for_each_direction<Dim>([&](auto d) {
      if (tiles[d] != KeyIndex::absent) {
        mpm::for_shared_nodes<Dim, mpm::opposite<Dim>(d)>([&](std::size_t in_block, std::size_t in_patch) {
          Real& clearance = nodes.clearance(b, in_block)[0];
          clearance = std::min(clearance, patches[static_cast<std::size_t>(tiles[d])].records[in_patch][0]);
        });
      }
    });
  });
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                            \
  template void set_reach<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const GroundOnGrid<Dim, Real>&,             \
                                     const std::vector<Real>&, mpm::Particles<Dim, Real>&);                         \
  template void clearances_to_grid<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const GroundOnGrid<Dim, Real>&,    \
                                              mpm::ShapeKind, const std::vector<Real>&, const mpm::HeldSides<Dim>&, \
                                              const mpm::Particles<Dim, Real>&, mpm::Nodes<Dim, Real>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::terrain
