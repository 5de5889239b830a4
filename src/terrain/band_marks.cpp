#include "terrain/band_marks.hpp"

#include "base/instances.hpp"
#include "mpm/particle_pass.hpp"
#include "terrain/band_marks_kernel.hpp"
#include "terrain/nodes_on_ground.hpp"

namespace thawslide::terrain {

template <int Dim, class Real>
void mark_band_and_slip(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground, Real dt,
                        mpm::Nodes<Dim, Real>& nodes, mpm::Particles<Dim, Real>& particles) {
  mpm::for_particles_in_memory(particles, LeaveBand<Dim, Real>{});
  mpm::particle_pass(grid, mpm::LinearWeights{}, particles, nodes, SeesCandidates<Dim, Real>{ground},
                     MarkBand<Dim, Real>{dt});
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                               \
  template void mark_band_and_slip<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const GroundOnGrid<Dim, Real>&, Real, \
                                              mpm::Nodes<Dim, Real>&, mpm::Particles<Dim, Real>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::terrain
