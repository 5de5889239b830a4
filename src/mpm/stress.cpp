// Strain, rotation, stress, volume and porosity of particles (Eqs. 6, 11).
#include "base/instances.hpp"
#include "mpm/motion.hpp"
#include "mpm/particle_pass.hpp"
#include "mpm/stress_kernel.hpp"

namespace thawslide::mpm {

template <int Dim, class Real>
StressWork<Real> update_stress_and_porosity(const SparseGrid<Dim, Real>& grid, Particles<Dim, Real>& particles,
                                            const MotionModel<Dim, Real>& model, Real dt, Nodes<Dim, Real>& nodes,
                                            InvalidParticle& invalid) {
  StressWork<Real> work;
  with_shape<Real>(model.shape, [&](auto shape) {
    const MomentumWeights<decltype(shape), Dim, Real> weights{model.sizes, model.sides};
    const Deformed<Real> deformed = with_width<Dim>(model.width, [&](const auto& width) {
      const UpdateStress<Dim, Real, std::decay_t<decltype(width)>> update{model.materials.data(), model.phases,
                                                                          model.effective_stress, dt, width};
      return std::get<0>(particle_pass(grid, weights, particles, nodes, every_tile, update));
    });
    work = deformed.work;
    invalid += deformed.invalid;
  });
  return work;
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                               \
  template StressWork<Real> update_stress_and_porosity<Dim, Real>(const SparseGrid<Dim, Real>&, Particles<Dim, Real>&, \
                                                                  const MotionModel<Dim, Real>&, Real,                 \
                                                                  Nodes<Dim, Real>&, InvalidParticle&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::mpm
