#include "terrain/near_ground.hpp"

#include "base/instances.hpp"
#include "mpm/node_pass.hpp"
#include "mpm/particle_pass.hpp"
#include "terrain/nodes_on_ground.hpp"

namespace thawslide::terrain {

namespace {

// The contact offset of boxes of half size `half` [m], how far they stretch towards the ground if that lies along a
// grid axis; seen: what they read of the patch.
template <int Dim, class Real>
Lanes<Real> contact_offset_of_box(const mpm::Reading<Dim, Lanes<Real>, 1 + Dim>& seen, Lanes<Real> half) {
  Lanes<Real> largest = Real(0);
  for (std::size_t a = 0; a < Dim; ++a) {
    largest = max(largest, abs(seen.value[Ground::normal + a]));
  }
  return half * largest;
}

}  // namespace

template <int Dim, class Real>
void set_contact_offset(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
                        const mpm::BodySizes<Real>& sizes, mpm::Particles<Dim, Real>& particles, std::size_t first) {
  constexpr Real within_lowest_layer = Real(2) * (Real(1) + round_off<Real>);  // times a particle's contact offset
  mpm::PatchOf<Ground, Dim, Real> patch;
  for (std::size_t t = 0; t < grid.tiles().size(); ++t) {
    load_patch(grid, t, GroundRecords<Dim, Real>{ground}, patch);
    for (const mpm::TileBatch<Dim, Real>& batch : grid.batches(t)) {
      const auto seen = mpm::read_nodes<1 + Dim>(linear_stencil(grid, particles, batch), patch);
      const Lanes<Real> contact_offset = contact_offset_of_box(seen, sizes.of(particles, batch).half * grid.cell());
      const Lanes<Real> distance = seen.value[Ground::distance];
      const Lanes<Real> found = select(distance < within_lowest_layer * contact_offset, distance, contact_offset);
      for (std::size_t lane = 0; lane < batch.count; ++lane) {
        if (batch.particle[lane] >= first) {
          particles.contact_offset(batch.particle[lane]) = found[lane];
        }
      }
    }
  }
}

template <int Dim, class Real>
void near_ground_to_grid(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
                         const mpm::MotionModel<Dim, Real>& model, mpm::Particles<Dim, Real>& particles,
                         mpm::Nodes<Dim, Real>& nodes) {
  const SeesCandidates<Dim, Real> sees_candidates{ground};
  NodesOnGround<Dim, Real> records{nodes, ground};
  mpm::with_shape<Real>(model.shape, [&](auto shape) {
    const mpm::MomentumWeights<decltype(shape), Dim, Real> weights{model.sizes, model.sides};
    mpm::particle_pass(grid, weights, particles, records, sees_candidates,
                       AddNearGround<Dim, Real>{model.phases, model.lubrication});
  });
  nodes.near_ground.hold(grid.blocks().size(), [&](std::size_t b) { return ground.any_candidate(b); });
  parallel_for(grid.blocks().size(), [&](std::size_t b) {
    if (ground.any_candidate(b)) {
      mpm::sum_block<mpm::NearGround>(grid, b, nodes, sees_candidates);
      mpm::sum_block<mpm::Clearance>(grid, b, nodes, sees_candidates);
    }
  });
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                             \
  template void set_contact_offset<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const GroundOnGrid<Dim, Real>&,     \
                                              const mpm::BodySizes<Real>&, mpm::Particles<Dim, Real>&, std::size_t); \
  template void near_ground_to_grid<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const GroundOnGrid<Dim, Real>&,    \
                                               const mpm::MotionModel<Dim, Real>&, mpm::Particles<Dim, Real>&,       \
                                               mpm::Nodes<Dim, Real>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::terrain
