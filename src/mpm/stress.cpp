// Strain, rotation, stress, volume and porosity of particles (Eqs. 6, 11).
#include "base/instances.hpp"
#include "mpm/motion.hpp"
#include "mpm/motion_stages.hpp"
#include "mpm/step_passes.hpp"

namespace thawslide::mpm {

template <int Dim>
Deformed update_stress_and_porosity(const SparseGrid<Dim>& grid, Particles<Dim>& particles,
                                    const MotionModel<Dim>& model, double dt, Nodes<Dim>& nodes) {
  StepPasses<Dim> passes(grid, {model.shape, model.sizes, model.sides}, particles, nodes);
  Deformed deformed;
  stages::update_stress_and_porosity<Dim>(passes, model, model.width.view(), dt, &deformed);
  return deformed;
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                                    \
  template Deformed update_stress_and_porosity<Dim>(const SparseGrid<Dim>&, Particles<Dim>&, const MotionModel<Dim>&, \
                                                    double, Nodes<Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::mpm
