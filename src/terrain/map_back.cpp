#include "terrain/map_back.hpp"

#include "base/instances.hpp"
#include "mpm/node_pass.hpp"
#include "terrain/contact_node.hpp"
#include "terrain/impulse_on_grid.hpp"

namespace thawslide::terrain {

using mpm::BaseLayout;
using mpm::Contact;
using mpm::MomentumLayout;

namespace {

template <int Dim>
constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);

// Fills BaseLayout::mapped_back of the nodes in contact.
template <int Dim, class Real>
void press_mapped_back(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
                       bool distance_check, Real dt, mpm::Nodes<Dim, Real>& nodes) {
  parallel_for(grid.blocks().size(), [&](std::size_t b) {
    for (std::size_t k = 0; nodes.contact.holds(b) && k < block_nodes<Dim>; ++k) {
      if (nodes.contact(b, k)[Contact::touching] > Real(0)) {
        nodes.base.of_block(b)[k][BaseLayout::mapped_back] =
            normal_impulse_at(grid, ground, nodes, distance_check, dt, b, k, [&](std::size_t block, std::size_t node) {
              return mpm::vector_at<Dim, Real>(nodes.velocity(block, node), 0);
            });
      }
    }
  });
}

}  // namespace

template <int Dim, class Real>
Real constrain_mapped_back(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>* ground,
                           const mpm::Constraints<Dim, Real>& constraints, const ContactModel<Dim, Real>& model,
                           const Vector<Real, Dim>& gravity, Real time, Real dt, mpm::Nodes<Dim, Real>& nodes) {
  nodes.velocity.resize(grid.blocks().size());
  parallel_for(grid.blocks().size(), [&](std::size_t b) { mpm::sum_block<mpm::Velocity>(grid, b, nodes); });
  if (ground != nullptr) {
    press_mapped_back(grid, *ground, model.distance_check, dt, nodes);
  }
  return parallel_sum<Real>(grid.blocks().size(), [&](std::size_t b, Real& work) {
    const mpm::BlockConstraints<Dim, Real> on_block(grid, constraints, b, time);
    for (std::size_t k = 0; k < block_nodes<Dim>; ++k) {
      const auto& record = nodes.momentum(b, k);
      if (!(record[MomentumLayout<Dim>::mass] > Real(0))) {
        continue;
      }
      Vector<Real, Dim> from_ground = Vector<Real, Dim>::Zero();
      if (ground != nullptr && nodes.contact.holds(b)) {
        from_ground = -nodes.base(b, k)[BaseLayout::mapped_back] * ground->block(b)[k].normal;
      }
      work += map_back<Dim>(mpm::NodeConstraints<Dim, Real>{on_block, k}, from_ground, gravity, dt, record,
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
