#include "terrain/map_back.hpp"

#include "base/instances.hpp"
#include "mpm/node_pass.hpp"

namespace thawslide::terrain {

using mpm::Contact;
using mpm::MomentumLayout;
using mpm::MotionLayout;

template <int Dim, class Real>
Real constrain_mapped_back(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>* ground,
                           const mpm::Constraints<Dim, Real>& constraints, const ContactModel<Dim, Real>& model,
                           const Vector<Real, Dim>& gravity, Real time, Real dt, mpm::Nodes<Dim, Real>& nodes) {
  using Layout = MomentumLayout<Dim>;
  nodes.velocity.resize(grid.blocks().size());
  return parallel_sum<Real>(grid.blocks().size(), [&](std::size_t b, Real& work) {
    mpm::sum_block<mpm::Velocity>(grid, b, nodes);
    const mpm::BlockConstraints<Dim, Real> on_block(grid, constraints, b, time);
    for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<Dim>::nodes); ++k) {
      const auto& record = nodes.momentum(b, k);
      const Real mass = record[Layout::mass];
      if (!(mass > Real(0))) {
        continue;
      }
      Vector<Real, Dim> momentum = mpm::vector_at<Dim, Real>(nodes.velocity(b, k), 0);
      if (ground != nullptr && nodes.contact(b, k)[Contact::touching] > Real(0)) {
        const Vector<Real, Dim>& normal = ground->block(b)[k].normal;
        momentum -= approach_of(nodes, b, k, model.distance_check, dt, mass, momentum.dot(normal)) * normal;
      }
      on_block.apply(k, mass, momentum);
      const Vector<Real, Dim> velocity = momentum * (Real(1) / mass);
      mpm::set_vector<Dim>(nodes.velocity(b, k), 0, velocity);
      const Vector<Real, Dim> internal_force = mpm::vector_at<Dim, Real>(record, Layout::force) - mass * gravity;
      const auto middle = mpm::vector_at<Dim, Real>(nodes.motion(b, k), MotionLayout<Dim>::middle_velocity);
      work += dt * internal_force.dot(middle - velocity);
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
