#include "terrain/gap.hpp"

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

// Distance of a particle's middle from the ground, and how far its box reaches towards it if it lies along a grid axis.
template <int Dim, class Real>
struct Above {
  Real distance = 0;
  Real reach = 0;
};

template <int Dim, class Real>
Above<Dim, Real> above_ground(const mpm::SparseGrid<Dim, Real>& grid, std::uint64_t tile,
                              const DistancePatch<Dim, Real>& patch, Real half,
                              const mpm::Particles<Dim, Real>& particles, std::uint32_t p) {
  Above<Dim, Real> above;
  Vector<Real, Dim> normal = Vector<Real, Dim>::Zero();
  mpm::hat_stencil(grid, tile, particles, p)
      .for_each_node([&](std::size_t place, Real weight, const Vector<Real, Dim>& /*slope*/) {
        above.distance += weight * patch.records[place][0];
        normal += weight * mpm::vector_at<Dim, Real>(patch.records[place], 1);
      });
  above.reach = half * grid.cell() * normal.cwiseAbs().maxCoeff();
  return above;
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
      const auto above =
          above_ground(grid, tile.key, patch, half_size[static_cast<std::size_t>(particles.body(p))], particles, p);
      const bool lowest = above.distance < Real(2) * above.reach * (Real(1) + round_off);
      particles.reach(p) = lowest ? above.distance : above.reach;
    }
  }
}

template <int Dim, class Real>
void gaps_to_grid(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground, mpm::ShapeKind shape,
                  const std::vector<Real>& half_size, const mpm::HeldSides<Dim>& sides,
                  const mpm::Particles<Dim, Real>& particles, mpm::Nodes<Dim, Real>& nodes) {
  constexpr Real far = std::numeric_limits<Real>::max();
  auto& patches = nodes.gap.patches(grid.tiles().size());
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
        const Real gap = std::max(
            Real(0), above_ground(grid, tile.key, distances, half, particles, p).distance - particles.reach(p));
        const auto place = mpm::place_of(grid, particles.position.template get<Vector<Real, Dim>>(p));
        const auto stencil = mpm::make_stencil<decltype(shape_function)>(grid, tile.key, place, half, sides);
        stencil.for_each_node([&](std::size_t node, Real weight, const Vector<Real, Dim>& /*slope*/) {
          if (weight > Real(0)) {
            patch.records[node][0] = std::min(patch.records[node][0], gap);
          }
        });
      }
    });
  });
  nodes.gap.resize(grid.blocks().size());
  parallel_for(grid.blocks().size(), [&](std::size_t b) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<Dim>::nodes); ++k) {
      nodes.gap(b, k)[0] = far;
    }
    const std::int32_t* tiles = grid.tiles_about_block(b);
    for (int d = 0; d < mpm::Tile<Dim>::stencil; ++d) {
      if (tiles[d] != KeyIndex::absent) {
        mpm::for_shared_nodes<Dim>(mpm::Tile<Dim>::stencil - 1 - d, [&](std::size_t in_block, std::size_t in_patch) {
          Real& gap = nodes.gap(b, in_block)[0];
          gap = std::min(gap, patches[static_cast<std::size_t>(tiles[d])].records[in_patch][0]);
        });
      }
    }
  });
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                      \
  template void set_reach<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const GroundOnGrid<Dim, Real>&,       \
                                     const std::vector<Real>&, mpm::Particles<Dim, Real>&);                   \
  template void gaps_to_grid<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const GroundOnGrid<Dim, Real>&,    \
                                        mpm::ShapeKind, const std::vector<Real>&, const mpm::HeldSides<Dim>&, \
                                        const mpm::Particles<Dim, Real>&, mpm::Nodes<Dim, Real>&);
THAWSLIDE_INSTANTIATE(2, double)
THAWSLIDE_INSTANTIATE(3, double)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::terrain
