#include "sim/front.hpp"

#include "base/error.hpp"
#include "base/instances.hpp"
#include "base/parallel.hpp"
#include "device/solver.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

template <int Dim>
MovedMass Simulation<Dim>::moved_mass() const {
  const BodySums<Dim> sums = sum_over_body();
  const auto all = static_cast<double>(sums.mass);
  double of_moved_bodies = all;
  for (std::size_t body = 0; body < bodies_at_start_.size(); ++body) {
    of_moved_bodies -= sums.moved_bodies.contains(body) ? 0.0 : bodies_at_start_[body].mass;
  }
  if (static_cast<double>(sums.moved_mass) > mpm::fraction_ahead_of_front * of_moved_bodies &&
      sums.moved_mass > Real(0)) {
    return {false, of_moved_bodies, sums.moved_bodies, true};
  }
  MovedMass released{false, all, {}};
  for (std::size_t body = 0; body < bodies_at_start_.size(); ++body) {
    if (is_held(body)) {
      released.mass -= bodies_at_start_[body].mass;
    } else {
      released.bodies.add(body);
    }
  }
  return released.mass < all && released.mass > round_off * all ? released : MovedMass{true, all, {}};
}

template <int Dim>
mpm::PathSample Simulation<Dim>::front(const MovedMass& mass, const LineView& line) const {
  THAWSLIDE_ASSERT(particle_count() > 0, "the front of {} particles", particle_count());
  mpm::Transformation<Dim> path{line, {}, mass.all, mass.bodies};
  for (std::size_t a = 0; a + 1 < Dim; ++a) {
    path.origin[a] = model_.origin[static_cast<int>(a)];
  }
  if (device_solver_) {
    mpm::PathSample found;
    on_device([&] { found = device_solver_->front(path, mass.mass); });
    return found;
  }
  const std::vector<std::uint32_t>& order = grid_.order();
  std::vector<MassOnPath> masses(order.size());
  parallel_for(order.size(), [&](std::size_t rank) {
    const mpm::PathSample one = path.of(particles_, order[rank]);
    masses[rank] = {one.along, one.mass, rank};
  });
  return path.of(particles_, order[front_of(masses, mass.mass).rank]);
}

#define THAWSLIDE_INSTANTIATE(Dim)                        \
  template MovedMass Simulation<Dim>::moved_mass() const; \
  template mpm::PathSample Simulation<Dim>::front(const MovedMass&, const LineView&) const;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
