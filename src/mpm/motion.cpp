#include "mpm/motion.hpp"

#include "base/instances.hpp"
#include "mpm/motion_stages.hpp"
#include "mpm/position_kernel.hpp"
#include "mpm/step_passes.hpp"
#include "mpm/velocity_filter.hpp"

namespace thawslide::mpm {

namespace {

template <int Dim>
StepPasses<Dim> passes_of(const SparseGrid<Dim>& grid, Particles<Dim>& particles, const MotionModel<Dim>& model,
                          Nodes<Dim>& nodes) {
  return {grid, {model.shape, model.sizes, model.sides}, particles, nodes};
}

}  // namespace

template <int Dim>
void split_total_stress(Particles<Dim>& particles, std::size_t first) {
  for (std::size_t p = first; p < particles.size(); ++p) {
    for (int c = 0; c < 3; ++c) {
      particles.stress(p, c) += particles.pore_pressure(p);
    }
  }
}

template <int Dim>
double momentum_to_grid(const SparseGrid<Dim>& grid, Particles<Dim>& particles, const MotionModel<Dim>& model,
                        Nodes<Dim>& nodes) {
  auto passes = passes_of(grid, particles, model, nodes);
  double of_walls = 0;
  stages::momentum_to_grid<Dim>(passes, model, model.width.view(), &of_walls);
  return of_walls;
}

template <int Dim>
double move_particles(const SparseGrid<Dim>& grid, Particles<Dim>& particles, const MotionModel<Dim>& model, double dt,
                      Nodes<Dim>& nodes) {
  auto passes = passes_of(grid, particles, model, nodes);
  double gained = 0;
  stages::move_particles<Dim>(passes, model, dt, &gained);
  return gained;
}

template <int Dim>
double filter_velocities(const SparseGrid<Dim>& grid, Particles<Dim>& particles, const MotionModel<Dim>& model,
                         Nodes<Dim>& nodes) {
  auto passes = passes_of(grid, particles, model, nodes);
  double gained = 0;
  stages::filter_velocities<Dim>(passes, model.filter_order, &gained);
  return gained;
}

template <int Dim>
InvalidParticle update_positions(Particles<Dim>& particles, const Vector<double, Dim>& lower,
                                 const Vector<double, Dim>& upper) {
  return for_particles_in_memory(particles, UpdatePosition<Dim>{lower, upper});
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                              \
  template void split_total_stress<Dim>(Particles<Dim>&, std::size_t);                                          \
  template double momentum_to_grid<Dim>(const SparseGrid<Dim>&, Particles<Dim>&, const MotionModel<Dim>&,       \
                                        Nodes<Dim>&);                                                           \
  template double move_particles<Dim>(const SparseGrid<Dim>&, Particles<Dim>&, const MotionModel<Dim>&, double, \
                                      Nodes<Dim>&);                                                             \
  template double filter_velocities<Dim>(const SparseGrid<Dim>&, Particles<Dim>&, const MotionModel<Dim>&,      \
                                         Nodes<Dim>&);                                                          \
  template InvalidParticle update_positions<Dim>(Particles<Dim>&, const Vector<double, Dim>&,                   \
                                                 const Vector<double, Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::mpm
