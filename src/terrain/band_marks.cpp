#include "terrain/band_marks.hpp"

#include "base/instances.hpp"
#include "mpm/batch_transfer.hpp"

namespace thawslide::terrain {

using mpm::ContactLayout;

template <int Dim, class Real>
void mark_band_and_slip(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground, Real dt,
                        const mpm::Nodes<Dim, Real>& nodes, mpm::Particles<Dim, Real>& particles) {
  const Lanes<Real> zero = Real(0);
  parallel_for(grid.tiles().size(), [&](std::size_t t) {
    if (!ground.any_near(t)) {
      for (const mpm::TileBatch<Dim, Real>& batch : grid.batches(t)) {
        particles.in_band.store_whole(batch, zero);
      }
      return;
    }
    const std::int32_t* blocks = grid.blocks_about_tile(t);
    // [candidate, touching, slip speed where touching] of the nodes about the tile.
    mpm::Patch<Dim, Real, 3> patch;
    mpm::for_each_direction<Dim>([&](auto d) {
      const auto b = static_cast<std::size_t>(blocks[d]);
      mpm::for_shared_nodes<Dim, d>([&](std::size_t in_block, std::size_t in_patch) {
        const auto& contact = nodes.contact(b, in_block);
        patch.records[in_patch] = {ground.block(b)[in_block].candidate ? Real(1) : Real(0),
                                   contact[ContactLayout::touching],
                                   contact[ContactLayout::touching] * contact[ContactLayout::slip_speed]};
      });
    });
    for (const mpm::TileBatch<Dim, Real>& batch : grid.batches(t)) {
      if (!ground.any_near(t, batch)) {
        particles.in_band.store_whole(batch, zero);
        continue;
      }
      const auto seen = mpm::read_nodes<3>(linear_stencil(grid, particles, batch), patch).value;
      particles.in_band.store_whole(batch, select(seen[0] > Real(0), Lanes<Real>(Real(1)), zero));
      const auto touches = seen[1] > Real(0);
      if (any(touches)) {
        const Lanes<Real> slip_speed = seen[2] / select(touches, seen[1], Lanes<Real>(Real(1)));
        const Lanes<Real> slip = particles.slip.load(batch);
        particles.slip.store(batch, select(touches, slip + dt * slip_speed, slip));
      }
    }
  });
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                               \
  template void mark_band_and_slip<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const GroundOnGrid<Dim, Real>&, Real, \
                                              const mpm::Nodes<Dim, Real>&, mpm::Particles<Dim, Real>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::terrain
