// Strain, rotation, stress, volume and porosity of particles (Eqs. 6, 11).
#include "base/instances.hpp"
#include "mpm/motion.hpp"
#include "mpm/particle_pass.hpp"
#include "mpm/stress_kernel.hpp"

namespace thawslide::mpm {

template <int Dim>
Deformed update_stress_and_porosity(const SparseGrid<Dim>& grid, Particles<Dim>& particles,
                                    const MotionModel<Dim>& model, double dt, Nodes<Dim>& nodes) {
  const MomentumWeights<Dim> weights{model.shape, model.sizes, model.sides};
  return with_width<Dim>(model.width.view(), [&](const auto& width) {
    const UpdateStress<Dim, std::decay_t<decltype(width)>> update{model.materials.data(), model.phases,
                                                                  model.effective_stress, dt, width};
    return std::get<0>(particle_pass(grid, weights, particles, nodes, every_tile, update));
  });
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                                    \
  template Deformed update_stress_and_porosity<Dim>(const SparseGrid<Dim>&, Particles<Dim>&, const MotionModel<Dim>&, \
                                                    double, Nodes<Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::mpm
