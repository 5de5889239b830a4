#include "terrain/clearance.hpp"

#include <algorithm>
#include <limits>

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
  for (int d = 0; d < mpm::Tile<Dim>::stencil; ++d) {
    const auto b = static_cast<std::size_t>(blocks[d]);
    any = any || ground.any_candidate(b);
    mpm::for_shared_nodes<Dim>(d, [&](std::size_t in_block, std::size_t in_patch) {
      const auto& known = ground.block(b)[in_block];
      patch.records[in_patch][0] = known.distance;
      mpm::set_vector<Dim>(patch.records[in_patch], 1, known.normal);
    });
  }
  return any;
}

// Distance of a particle's middle from the ground, by the hats.
template <int Dim, class Real>
Real distance_of(const mpm::Stencil<Dim, Real, 2>& stencil, const DistancePatch<Dim, Real>& patch) {
  Real distance = 0;
  stencil.for_each_node([&](std::size_t place, Real weight, const Vector<Real, Dim>& /*slope*/) {
    distance += weight * patch.records[place][0];
  });
  return distance;
}

// How far a particle's box of half size `half` [m] reaches towards the ground if that lies along a grid axis.
template <int Dim, class Real>
Real reach_of_box(const mpm::Stencil<Dim, Real, 2>& stencil, const DistancePatch<Dim, Real>& patch, Real half) {
  Vector<Real, Dim> normal = Vector<Real, Dim>::Zero();
  stencil.for_each_node([&](std::size_t place, Real weight, const Vector<Real, Dim>& /*slope*/) {
    normal += weight * mpm::vector_at<Dim, Real>(patch.records[place], 1);
  });
  return half * normal.cwiseAbs().maxCoeff();
}

}  // namespace

template <int Dim, class Real>
void set_reach(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
               const std::vector<Real>& half_size, mpm::Particles<Dim, Real>& particles) {
  constexpr Real round_off = static_cast<Real>(1e-9);
  DistancePatch<Dim, Real> patch;
  for (std::size_t t = 0; t < grid.tiles().size(); ++t) {
    const auto& tile = grid.tiles()[t];
    load_distances(grid, ground, t, patch);
    for (std::uint32_t k = tile.first; k < tile.last; ++k) {
      const std::uint32_t p = grid.order()[k];
      const auto stencil = mpm::hat_stencil(grid, tile.key, particles, p);
      const Real distance = distance_of(stencil, patch);
      const Real reach =
          reach_of_box(stencil, patch, half_size[static_cast<std::size_t>(particles.body(p))] * grid.cell());
      const bool lowest = distance < Real(2) * reach * (Real(1) + round_off);
      particles.reach(p) = lowest ? distance : reach;
    }
  }
}

template <int Dim, class Real>
void clearances_to_grid(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
                        mpm::ShapeKind shape, const std::vector<Real>& half_size, const mpm::HeldSides<Dim>& sides,
                        const mpm::Particles<Dim, Real>& particles, mpm::Nodes<Dim, Real>& nodes) {
  constexpr Real far = std::numeric_limits<Real>::max();
  auto& patches = nodes.clearance.patches(grid.tiles().size());
  mpm::with_shape<Real>(shape, [&](auto shape_function) {
    parallel_for(grid.tiles().size(), [&](std::size_t t) {
      auto& patch = patches[t];
      patch.records.fill({far});
      DistancePatch<Dim, Real> distances;
      if (!load_distances(grid, ground, t, distances)) {
        return;
      }
      const auto& tile = grid.tiles()[t];
      for (std::uint32_t k = tile.first; k < tile.last; ++k) {
        const std::uint32_t p = grid.order()[k];
        const Real half = half_size[static_cast<std::size_t>(particles.body(p))];
        const Real distance = distance_of(mpm::hat_stencil(grid, tile.key, particles, p), distances);
        const Real clearance = std::max(Real(0), distance - particles.reach(p));
        const auto place = mpm::place_of(grid, particles.position.template get<Vector<Real, Dim>>(p));
        const auto stencil = mpm::make_stencil<decltype(shape_function)>(grid, tile.key, place, half, sides);
        stencil.for_each_node([&](std::size_t node, Real weight, const Vector<Real, Dim>& /*slope*/) {
          if (weight > Real(0)) {
            patch.records[node][0] = std::min(patch.records[node][0], clearance);
          }
        });
      }
    });
  });
  nodes.clearance.resize(grid.blocks().size());
  parallel_for(grid.blocks().size(), [&](std::size_t b) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<Dim>::nodes); ++k) {
      nodes.clearance(b, k)[0] = far;
    }
    const std::int32_t* tiles = grid.tiles_about_block(b);
    for (int d = 0; d < mpm::Tile<Dim>::stencil; ++d) {
      if (tiles[d] != KeyIndex::absent) {
        mpm::for_shared_nodes<Dim>(mpm::Tile<Dim>::stencil - 1 - d, [&](std::size_t in_block, std::size_t in_patch) {
          Real& clearance = nodes.clearance(b, in_block)[0];
          clearance = std::min(clearance, patches[static_cast<std::size_t>(tiles[d])].records[in_patch][0]);
        });
      }
    }
  });
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                            \
  template void set_reach<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const GroundOnGrid<Dim, Real>&,             \
                                     const std::vector<Real>&, mpm::Particles<Dim, Real>&);                         \
  template void clearances_to_grid<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const GroundOnGrid<Dim, Real>&,    \
                                              mpm::ShapeKind, const std::vector<Real>&, const mpm::HeldSides<Dim>&, \
                                              const mpm::Particles<Dim, Real>&, mpm::Nodes<Dim, Real>&);
THAWSLIDE_INSTANTIATE(2, double)
THAWSLIDE_INSTANTIATE(3, double)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::terrain
