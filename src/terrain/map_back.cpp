#include "terrain/map_back.hpp"

#include "base/instances.hpp"
#include "mpm/node_pass.hpp"
#include "terrain/contact_node.hpp"

namespace thawslide::terrain {

using mpm::Contact;
using mpm::MomentumLayout;

template <int Dim, class Real>
Real constrain_mapped_back(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>* ground,
                           const mpm::Constraints<Dim, Real>& constraints, const ContactModel<Dim, Real>& model,
                           const Vector<Real, Dim>& gravity, Real time, Real dt, mpm::Nodes<Dim, Real>& nodes) {
  nodes.velocity.resize(grid.blocks().size());
  return parallel_sum<Real>(grid.blocks().size(), [&](std::size_t b, Real& work) {
    mpm::sum_block<mpm::Velocity>(grid, b, nodes);
    const mpm::BlockConstraints<Dim, Real> on_block(grid, constraints, b, time);
    for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<Dim>::nodes); ++k) {
      const auto& record = nodes.momentum(b, k);
      if (!(record[MomentumLayout<Dim>::mass] > Real(0))) {
        continue;
      }
      const bool touching = ground != nullptr && nodes.contact(b, k)[Contact::touching] > Real(0);
      const GroundOfMappedBack<Dim, Real> below{
          touching, model.distance_check, touching ? &ground->block(b)[k].normal : nullptr,
          touching ? nodes.near_ground(b, k)[mpm::NearGround::clearance] : Real(0)};
      work += map_back<Dim>(mpm::NodeConstraints<Dim, Real>{on_block, k}, below, gravity, dt, record,
                            nodes.motion(b, k), nodes.velocity(b, k));
    }
  });
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                             \
  template Real constrain_mapped_back<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const GroundOnGrid<Dim, Real>*,  \
                                                 const mpm::Constraints<Dim, Real>&, const ContactModel<Dim, Real>&, \
                                                 const Vector<Real, Dim>&, Real, Real, mpm::Nodes<Dim, Real>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::terrain
