#include "terrain/near_ground.hpp"

#include <limits>

#include "base/instances.hpp"
#include "mpm/node_pass.hpp"
#include "mpm/particle_pass.hpp"
#include "terrain/nodes_on_ground.hpp"

namespace thawslide::terrain {

namespace {

// Contact offset of boxes of half size `half` [m]: their extent towards the ground, if that lies along a grid axis.
// seen: planes interpolated from the patch.
template <int Dim>
Simd<Real> contact_offset_of_box(const mpm::Reading<Dim, Simd<Real>, 1 + Dim>& seen, Simd<Real> half) {
  Simd<Real> largest = Real(0);
  for (std::size_t a = 0; a < Dim; ++a) {
    largest = max(largest, abs(seen.value[mpm::Planes::normal + a]));
  }
  return half * largest;
}

// Smallest distance of particles from the planes of the nodes in reach [m].
template <int Dim>
Simd<Real> smallest_gap(const mpm::BatchStencil<Dim>& stencil, const mpm::Particles<Dim>& particles,
                        const mpm::TileBatch<Dim>& batch, const mpm::PatchOf<mpm::Planes, Dim>& planes) {
  Simd<Real> point[Dim];
  for (int a = 0; a < Dim; ++a) {
    point[a] = particles.position.load(batch, a);
  }
  Simd<Real> smallest = std::numeric_limits<Real>::max();
  mpm::with_fetch(stencil.nodes, planes, [&](const auto& fetch) {
    mpm::for_each_node<Dim>(
        stencil.axis, 0, [&](std::size_t offset, Simd<Real> weight, const Vector<Simd<Real>, Dim>& /*slope*/) {
          const Simd<Real> gap = mpm::gap_to_plane<Dim>(
              point, Simd<Real>(Real(0)), [&](std::size_t component) { return fetch(offset, component); });
          smallest = select(weight > round_off, min(smallest, gap), smallest);
        });
  });
  return smallest;
}

}  // namespace

template <int Dim>
void set_contact_offset(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>& ground,
                        const mpm::MotionModel<Dim>& model, mpm::Particles<Dim>& particles, std::size_t first) {
  // in units of a particle's contact offset
  constexpr Real within_lowest_layer = Real(2) * (Real(1) + round_off);
  if (grid.mapping().follows_ground) {
    for (std::size_t p = first; p < particles.size(); ++p) {
      const Real half = model.sizes.half(static_cast<std::size_t>(particles.body(p))) * grid.cell();
      const Real height = particles.height_above_ground(p);
      particles.contact_offset(p) = height < within_lowest_layer * half ? height : half;
    }
    return;
  }
  mpm::PatchOf<mpm::Planes, Dim> patch;
  const mpm::MomentumWeights<Dim> weights{model.shape, model.sizes, model.sides};
  for (std::size_t t = 0; t < grid.tiles().size(); ++t) {
    load_patch(grid, t, PlanesOfGround<Dim>{ground}, patch);
    for (const mpm::TileBatch<Dim>& batch : grid.batches(t)) {
      const mpm::BatchWeights<mpm::MomentumWeights<Dim>, Dim> of_batch(weights, grid, particles, batch);
      const auto seen = mpm::read_nodes<1 + Dim>(of_batch.linear, patch);
      const Simd<Real> of_box = contact_offset_of_box(seen, model.sizes.of(particles, batch).half * grid.cell());
      const Simd<Real> gap = smallest_gap(of_batch.momentum, particles, batch, patch);
      const Simd<Real> found = select(gap < within_lowest_layer * of_box, gap, of_box);
      for (std::size_t lane = 0; lane < batch.count; ++lane) {
        if (batch.particle[lane] >= first) {
          particles.contact_offset(batch.particle[lane]) = found[lane];
        }
      }
    }
  }
}

namespace {

// Scatters particles to the candidate nodes with a kernel, and sums the named parts of their records over tiles.
template <class... Parts, int Dim, class Kernel>
void to_candidates(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>& ground,
                   const mpm::MotionModel<Dim>& model, const Kernel& kernel, mpm::Particles<Dim>& particles,
                   mpm::Nodes<Dim>& nodes) {
  const SeesCandidates<Dim> sees_candidates{ground};
  NodesOnGround<Dim> records{nodes, ground};
  const mpm::MomentumWeights<Dim> weights{model.shape, model.sizes, model.sides};
  mpm::particle_pass(grid, weights, particles, records, sees_candidates, kernel);
  nodes.near_ground.allocate(grid.blocks().size(), [&](std::size_t b) { return ground.any_candidate(b); });
  parallel_for(grid.blocks().size(), [&](std::size_t b) {
    if (ground.any_candidate(b)) {
      (mpm::sum_block<Parts>(grid, b, nodes, sees_candidates), ...);
    }
  });
}

}  // namespace

template <int Dim>
void near_ground_to_grid(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>& ground,
                         const mpm::MotionModel<Dim>& model, mpm::Particles<Dim>& particles, mpm::Nodes<Dim>& nodes) {
  to_candidates<mpm::NearGround, mpm::Clearance>(
      grid, ground, model, AddNearGround<Dim>{model.phases, model.lubrication, grid.mapping().follows_ground},
      particles, nodes);
}

template <int Dim>
void clearance_to_grid(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>& ground,
                       const mpm::MotionModel<Dim>& model, mpm::Particles<Dim>& particles, mpm::Nodes<Dim>& nodes) {
  to_candidates<mpm::Clearance>(grid, ground, model, LowerClearance<Dim>{grid.mapping().follows_ground}, particles,
                                nodes);
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                            \
  template void set_contact_offset<Dim>(const mpm::SparseGrid<Dim>&, const GroundOnGrid<Dim>&,                \
                                        const mpm::MotionModel<Dim>&, mpm::Particles<Dim>&, std::size_t);     \
  template void clearance_to_grid<Dim>(const mpm::SparseGrid<Dim>&, const GroundOnGrid<Dim>&,                 \
                                       const mpm::MotionModel<Dim>&, mpm::Particles<Dim>&, mpm::Nodes<Dim>&); \
  template void near_ground_to_grid<Dim>(const mpm::SparseGrid<Dim>&, const GroundOnGrid<Dim>&,               \
                                         const mpm::MotionModel<Dim>&, mpm::Particles<Dim>&, mpm::Nodes<Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::terrain
