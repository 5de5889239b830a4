#include "terrain/map_back.hpp"

#include "base/instances.hpp"
#include "mpm/node_pass.hpp"
#include "terrain/block_step.hpp"
#include "terrain/contact_stage.hpp"

namespace thawslide::terrain {

template <int Dim>
double constrain_mapped_back(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>* ground,
                             const mpm::Constraints<Dim>& constraints, const ContactModel<Dim>& model,
                             const Vector<double, Dim>& gravity, double time, double dt, mpm::Nodes<Dim>& nodes) {
  nodes.velocity.resize(grid.blocks().size());
  return parallel_sum<double>(grid.blocks().size(), [&](std::size_t b, double& work) {
    mpm::sum_block<mpm::Velocity>(grid, b, nodes);
    const BlockStep<Dim> step(grid, ground, constraints, model, time, dt, nodes, b);
    for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<Dim>::nodes); ++k) {
      const bool touching = ground != nullptr && nodes.contact(b, k)[mpm::Contact::touching] > 0.0;
      work += map_back_node(step, mpm::NodeAt{b, k}, touching, gravity);
    }
  });
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                   \
  template double constrain_mapped_back<Dim>(const mpm::SparseGrid<Dim>&, const GroundOnGrid<Dim>*,  \
                                             const mpm::Constraints<Dim>&, const ContactModel<Dim>&, \
                                             const Vector<double, Dim>&, double, double, mpm::Nodes<Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::terrain
