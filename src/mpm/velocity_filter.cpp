#include "mpm/velocity_filter.hpp"

#include "base/instances.hpp"
#include "mpm/filter_kernels.hpp"
#include "mpm/filter_node.hpp"
#include "mpm/particle_pass.hpp"

namespace thawslide::mpm {

namespace {

// Sums the particle contributions, and computes the next increments: the fit itself, or the last increment minus the
// fit.
template <int Dim>
void make_increments(const SparseGrid<Dim>& grid, bool first, Nodes<Dim>& nodes) {
  const double least = least_square_of(grid.cell());
  sum_patches(grid, nodes.filter_momentum, [&](std::size_t b) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(Tile<Dim>::nodes); ++k) {
      make_increment<Dim>(first, least, nodes.momentum(b, k), nodes.filter_moments(b, k), nodes.filter_momentum(b, k),
                          nodes.filter_increment(b, k), nodes.filter_total(b, k));
    }
  });
}

}  // namespace

template <int Dim>
double filter_velocities(const SparseGrid<Dim>& grid, Particles<Dim>& particles, const MotionModel<Dim>& model,
                         Nodes<Dim>& nodes) {
  nodes.filter_increment.resize(grid.blocks().size());
  nodes.filter_total.resize(grid.blocks().size());
  const MomentumWeights<Dim> weights{model.shape, model.sizes, model.sides};
  const auto pass = [&](const auto& kernel) {
    return std::get<0>(particle_pass(grid, weights, particles, nodes, every_tile, kernel));
  };
  pass(AddFilterMoments<Dim>{});
  sum_patches(grid, nodes.filter_moments);
  pass(AddFilterMomentum<Dim>{});
  make_increments(grid, true, nodes);
  for (int order = 2; order <= model.filter_order; ++order) {
    pass(SweepFilter<Dim>{});
    make_increments(grid, false, nodes);
  }
  return pass(ApplyFiltered<Dim>{});
}

#define THAWSLIDE_INSTANTIATE(Dim) \
  template double filter_velocities<Dim>(const SparseGrid<Dim>&, Particles<Dim>&, const MotionModel<Dim>&, Nodes<Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::mpm
