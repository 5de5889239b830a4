#include "mpm/motion.hpp"

#include "base/error.hpp"
#include "base/instances.hpp"
#include "mpm/motion_kernels.hpp"
#include "mpm/particle_pass.hpp"
#include "mpm/position_kernel.hpp"

namespace thawslide::mpm {

namespace {

// Calls work(weights) with the shape functions of the run, and the weights of APIC if it uses them.
template <int Dim, class Work>
void with_weights(const MotionModel<Dim>& model, const Work& work) {
  const MomentumWeights<Dim> weights{model.shape, model.sizes, model.sides};
  if (model.is_affine()) {
    work(AffineWeights<Dim>{weights});
  } else {
    work(weights);
  }
}

template <class Weights>
inline constexpr bool is_affine = false;
template <int Dim>
inline constexpr bool is_affine<AffineWeights<Dim>> = true;

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
  double of_walls = 0;
  with_weights(model, [&](const auto& weights) {
    with_width<Dim>(model.width.view(), [&](const auto& width) {
      using Width = std::decay_t<decltype(width)>;
      const AddMomentum<Dim, Width> add{model.gravity, model.effective_stress, model.viscous(), width};
      const auto sums = particle_pass(grid, weights, particles, nodes, every_tile, add);
      if constexpr (Width::varies) {
        of_walls = std::get<0>(sums);
      }
    });
    if constexpr (is_affine<std::decay_t<decltype(weights)>>) {
      particle_pass(grid, weights, particles, nodes, every_tile, AddAffineMomentum<Dim>{});
    }
  });
  sum_patches(grid, nodes.momentum);
  return of_walls;
}

template <int Dim>
double move_particles(const SparseGrid<Dim>& grid, Particles<Dim>& particles, const MotionModel<Dim>& model, double dt,
                      Nodes<Dim>& nodes) {
  double particle_kinetic = 0;
  with_weights(model, [&](const auto& weights) {
    const double pic_fraction = is_affine<std::decay_t<decltype(weights)>> ? 1.0 : model.pic_fraction;
    particle_kinetic =
        std::get<0>(particle_pass(grid, weights, particles, nodes, every_tile, Move<Dim>{pic_fraction, dt}));
    if constexpr (is_affine<std::decay_t<decltype(weights)>>) {
      particle_kinetic += std::get<0>(particle_pass(grid, weights, particles, nodes, every_tile, MoveAffine<Dim>{dt}));
    }
  });
  return particle_kinetic;
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
  template InvalidParticle update_positions<Dim>(Particles<Dim>&, const Vector<double, Dim>&,                   \
                                                 const Vector<double, Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::mpm
