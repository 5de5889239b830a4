#include "terrain/band_marks.hpp"

#include "base/instances.hpp"
#include "mpm/particle_pass.hpp"
#include "terrain/band_marks_kernel.hpp"
#include "terrain/nodes_on_ground.hpp"

namespace thawslide::terrain {

template <int Dim>
void mark_band_and_slip(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>& ground, double dt,
                        mpm::Nodes<Dim>& nodes, mpm::Particles<Dim>& particles) {
  mpm::for_particles_in_memory(particles, LeaveBand<Dim>{});
  mpm::particle_pass(grid, mpm::LinearWeights{}, particles, nodes, SeesCandidates<Dim>{ground}, MarkBand<Dim>{dt});
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                     \
  template void mark_band_and_slip<Dim>(const mpm::SparseGrid<Dim>&, const GroundOnGrid<Dim>&, double, \
                                        mpm::Nodes<Dim>&, mpm::Particles<Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::terrain
