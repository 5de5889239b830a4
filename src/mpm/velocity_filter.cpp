#include "mpm/velocity_filter.hpp"

#include "base/instances.hpp"
#include "mpm/filter_kernels.hpp"
#include "mpm/particle_pass.hpp"

namespace thawslide::mpm {

namespace {

// Mean square distance of masses from an axis, over the cell's square, below which they do not turn about it.
constexpr double least_square = 1e-8;

// What fits the velocities that particles have just brought: a node's rigid motion, as the records of motions hold it.
template <int Dim, class Real>
Vector<Real, components_of<FilterMomentum, Dim>> fitted(const SparseGrid<Dim, Real>& grid,
                                                        const Nodes<Dim, Real>& nodes, std::size_t b, std::size_t k) {
  constexpr int turns = physics::rotations<Dim>;
  const auto& moments = nodes.filter_moments(b, k);
  const auto& momentum = nodes.filter_momentum(b, k);
  const physics::MassPoints<Dim, Real> points{
      nodes.momentum(b, k)[MomentumLayout<Dim>::mass], vector_at<Dim, Real>(moments, FilterMoments::first),
      vector_at<physics::squares<Dim>, Real>(moments, Dim), vector_at<Dim, Real>(momentum, FilterMomentum::momentum),
      vector_at<turns, Real>(momentum, Dim)};
  const Real least = static_cast<Real>(least_square) * grid.cell() * grid.cell();
  const physics::RigidMotion<Dim, Real> motion = physics::nearest_rigid_motion(points, least);
  Vector<Real, Dim + turns> numbers;
  numbers << motion.at_origin, motion.rotation;
  return numbers;
}

// Sums what particles brought, and makes the next increments of it: the fit itself, or what the last ones are short of.
template <int Dim, class Real>
void make_increments(const SparseGrid<Dim, Real>& grid, bool first, Nodes<Dim, Real>& nodes) {
  constexpr int size = components_of<FilterMomentum, Dim>;
  sum_patches(grid, nodes.filter_momentum, [&](std::size_t b) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(Tile<Dim>::nodes); ++k) {
      auto& increment = nodes.filter_increment(b, k);
      auto& total = nodes.filter_total(b, k);
      if (first) {
        increment.fill(Real(0));
        total.fill(Real(0));
      }
      if (!(nodes.momentum(b, k)[MomentumLayout<Dim>::mass] > Real(0))) {
        continue;
      }
      const Vector<Real, size> fit = fitted(grid, nodes, b, k);
      const Vector<Real, size> next = first ? fit : Vector<Real, size>(vector_at<size, Real>(increment, 0) - fit);
      set_vector<size>(increment, 0, next);
      set_vector<size>(total, 0, Vector<Real, size>(vector_at<size, Real>(total, 0) + next));
    }
  });
}

}  // namespace

template <int Dim, class Real>
Real filter_velocities(const SparseGrid<Dim, Real>& grid, Particles<Dim, Real>& particles,
                       const MotionModel<Dim, Real>& model, Nodes<Dim, Real>& nodes) {
  Real gained = 0;
  nodes.filter_increment.resize(grid.blocks().size());
  nodes.filter_total.resize(grid.blocks().size());
  with_shape<Real>(model.shape, [&](auto shape) {
    const MomentumWeights<decltype(shape), Dim, Real> weights{model.sizes, model.sides};
    const auto pass = [&](const auto& kernel) {
      return std::get<0>(particle_pass(grid, weights, particles, nodes, every_tile, kernel));
    };
    pass(AddFilterMoments<Dim, Real>{});
    sum_patches(grid, nodes.filter_moments);
    pass(AddFilterMomentum<Dim, Real>{});
    make_increments(grid, true, nodes);
    for (int order = 2; order <= model.filter_order; ++order) {
      pass(SweepFilter<Dim, Real>{});
      make_increments(grid, false, nodes);
    }
    gained = pass(TakeFiltered<Dim, Real>{});
  });
  return gained;
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                          \
  template Real filter_velocities<Dim, Real>(const SparseGrid<Dim, Real>&, Particles<Dim, Real>&, \
                                             const MotionModel<Dim, Real>&, Nodes<Dim, Real>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::mpm
