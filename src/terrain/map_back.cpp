#include "terrain/map_back.hpp"

#include "base/instances.hpp"
#include "mpm/node_pass.hpp"
#include "terrain/contact_node.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::terrain {

using mpm::Contact;
using mpm::MomentumLayout;

template <int Dim>
double constrain_mapped_back(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>* ground,
                             const mpm::Constraints<Dim>& constraints, const ContactModel<Dim>& model,
                             const Vector<double, Dim>& gravity, double time, double dt, mpm::Nodes<Dim>& nodes) {
  nodes.velocity.resize(grid.blocks().size());
  return parallel_sum<double>(grid.blocks().size(), [&](std::size_t b, double& work) {
    mpm::sum_block<mpm::Velocity>(grid, b, nodes);
    const mpm::BlockConstraints<Dim> on_block(grid, constraints, b, time);
    for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<Dim>::nodes); ++k) {
      const auto& record = nodes.momentum(b, k);
      if (!(record[MomentumLayout<Dim>::mass] > 0.0)) {
        continue;
      }
      const bool touching = ground != nullptr && nodes.contact(b, k)[Contact::touching] > 0.0;
      GroundOfMappedBack<Dim> below{touching, model.distance_check, nullptr, 0.0};
      if (touching) {
        below.normal = &ground->block(b)[k].normal;
        below.clearance = clearance_along_normal(*below.normal, nodes.near_ground(b, k)[mpm::NearGround::clearance]);
      }
      work += map_back<Dim>(mpm::NodeConstraints<Dim>{on_block, k}, below, gravity, dt, record, nodes.motion(b, k),
                            nodes.velocity(b, k));
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
