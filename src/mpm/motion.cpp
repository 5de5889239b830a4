#include "mpm/motion.hpp"

#include "base/error.hpp"
#include "base/instances.hpp"
#include "mpm/motion_kernels.hpp"
#include "mpm/particle_pass.hpp"
#include "mpm/position_kernel.hpp"

namespace thawslide::mpm {

namespace {

// Calls work(weights) with the shape functions of the run, and the weights of APIC if it uses them.
template <int Dim, class Real, class Work>
void with_weights(const MotionModel<Dim, Real>& model, const Work& work) {
  const auto with = [&](auto shape) {
    using Shape = decltype(shape);
    if constexpr (!std::is_same_v<Shape, Linear<Real>>) {
      if (model.transfer == TransferKind::apic) {
        work(AffineWeights<Shape, Dim, Real>{{model.sizes, model.sides}});
        return;
      }
    }
    THAWSLIDE_ASSERT(model.transfer != TransferKind::apic, "APIC with linear shape functions");
    work(MomentumWeights<Shape, Dim, Real>{model.sizes, model.sides});
  };
  with_shape<Real>(model.shape, with);
}

template <class Weights>
inline constexpr bool is_affine = false;
template <class Shape, int Dim, class Real>
inline constexpr bool is_affine<AffineWeights<Shape, Dim, Real>> = true;

}  // namespace

template <int Dim, class Real>
void split_total_stress(Particles<Dim, Real>& particles, std::size_t first) {
  for (std::size_t p = first; p < particles.size(); ++p) {
    for (int c = 0; c < 3; ++c) {
      particles.stress(p, c) += particles.pore_pressure(p);
    }
  }
}

template <int Dim, class Real>
Real momentum_to_grid(const SparseGrid<Dim, Real>& grid, Particles<Dim, Real>& particles,
                      const MotionModel<Dim, Real>& model, Nodes<Dim, Real>& nodes) {
  Real of_walls = 0;
  with_weights(model, [&](const auto& weights) {
    with_width<Dim>(model.width, [&](const auto& width) {
      using Width = std::decay_t<decltype(width)>;
      const AddMomentum<Dim, Real, Width> add{model.gravity, model.effective_stress, model.viscous(), width};
      const auto sums = particle_pass(grid, weights, particles, nodes, every_tile, add);
      if constexpr (Width::varies) {
        of_walls = std::get<0>(sums);
      }
    });
    if constexpr (is_affine<std::decay_t<decltype(weights)>>) {
      particle_pass(grid, weights, particles, nodes, every_tile, AddAffineMomentum<Dim, Real>{});
    }
  });
  sum_patches(grid, nodes.momentum);
  return of_walls;
}

template <int Dim, class Real>
MoveWork<Real> move_particles(const SparseGrid<Dim, Real>& grid, Particles<Dim, Real>& particles,
                              const MotionModel<Dim, Real>& model, Real dt, Nodes<Dim, Real>& nodes) {
  MoveWork<Real> work;
  with_weights(model, [&](const auto& weights) {
    const Real pic_share = is_affine<std::decay_t<decltype(weights)>> ? Real(1) : model.pic_share;
    work.particle_kinetic =
        std::get<0>(particle_pass(grid, weights, particles, nodes, every_tile, Move<Dim, Real>{pic_share, dt}));
    if constexpr (is_affine<std::decay_t<decltype(weights)>>) {
      work.particle_kinetic +=
          std::get<0>(particle_pass(grid, weights, particles, nodes, every_tile, MoveAffine<Dim, Real>{dt}));
    }
  });
  return work;
}

template <int Dim, class Real>
void update_positions(Particles<Dim, Real>& particles, const Vector<Real, Dim>& lower, const Vector<Real, Dim>& upper,
                      InvalidParticle& invalid) {
  invalid += for_particles_in_memory(particles, UpdatePosition<Dim, Real>{lower, upper});
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                               \
  template void split_total_stress<Dim, Real>(Particles<Dim, Real>&, std::size_t);                                     \
  template Real momentum_to_grid<Dim, Real>(const SparseGrid<Dim, Real>&, Particles<Dim, Real>&,                       \
                                            const MotionModel<Dim, Real>&, Nodes<Dim, Real>&);                         \
  template MoveWork<Real> move_particles<Dim, Real>(const SparseGrid<Dim, Real>&, Particles<Dim, Real>&,               \
                                                    const MotionModel<Dim, Real>&, Real, Nodes<Dim, Real>&);           \
  template void update_positions<Dim, Real>(Particles<Dim, Real>&, const Vector<Real, Dim>&, const Vector<Real, Dim>&, \
                                            InvalidParticle&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::mpm
