#include "terrain/near_ground.hpp"

#include "base/instances.hpp"
#include "mpm/node_pass.hpp"
#include "mpm/particle_pass.hpp"
#include "terrain/nodes_on_ground.hpp"

namespace thawslide::terrain {

template <int Dim>
void set_contact_offset(const mpm::BodySizes& sizes, double cell, mpm::Particles<Dim>& particles, std::size_t first) {
  constexpr double within_lowest_layer = 2.0 * (1.0 + round_off);  // in half sizes of a particle
  for (std::size_t p = first; p < particles.size(); ++p) {
    const double half = sizes.half(static_cast<std::size_t>(particles.body(p))) * cell;
    const double height = particles.height_above_ground(p);
    particles.contact_offset(p) = height < within_lowest_layer * half ? height : half;
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
  to_candidates<mpm::NearGround, mpm::Clearance>(grid, ground, model,
                                                 AddNearGround<Dim>{model.phases, model.lubrication}, particles, nodes);
}

template <int Dim>
void clearance_to_grid(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>& ground,
                       const mpm::MotionModel<Dim>& model, mpm::Particles<Dim>& particles, mpm::Nodes<Dim>& nodes) {
  to_candidates<mpm::Clearance>(grid, ground, model, LowerClearance<Dim>{}, particles, nodes);
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                            \
  template void set_contact_offset<Dim>(const mpm::BodySizes&, double, mpm::Particles<Dim>&, std::size_t);    \
  template void clearance_to_grid<Dim>(const mpm::SparseGrid<Dim>&, const GroundOnGrid<Dim>&,                 \
                                       const mpm::MotionModel<Dim>&, mpm::Particles<Dim>&, mpm::Nodes<Dim>&); \
  template void near_ground_to_grid<Dim>(const mpm::SparseGrid<Dim>&, const GroundOnGrid<Dim>&,               \
                                         const mpm::MotionModel<Dim>&, mpm::Particles<Dim>&, mpm::Nodes<Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::terrain
