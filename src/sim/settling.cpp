// Settling: gravity is applied before t = 0, with damping and on a fixed base.
#include <cmath>
#include <utility>

#include "band/basal_segments.hpp"
#include "base/error.hpp"
#include "base/instances.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

template <int Dim>
bool Simulation<Dim>::needs_settling() const {
  return parameters_.mechanics.enabled && parameters_.mechanics.initial_stress == config::InitialStress::settle;
}

template <int Dim>
bool Simulation<Dim>::settle(const std::function<bool()>& may_continue) {
  if (!needs_settling()) {
    return true;
  }
  THAWSLIDE_ASSERT(particles_.size() == static_cast<std::size_t>(next_id_), "{} particles joined before the settling",
                   static_cast<std::size_t>(next_id_) - particles_at_start_);
  release_device();
  const Model<Dim> model = model_;
  model_.band.heat = model_.band.pressure = false;
  model_.constraints.frames.clear();
  model_.release_times.clear();  // all bodies settle together
  model_.splits_stretched = false;
  model_.contact.base_is_fixed = true;
  model_.contact.band_columns = false;
  band_columns_.reset();
  model_.contact.mass_damping = static_cast<Real>(parameters_.mechanics.settle_damping);
  // No particle may leave.
  const config::Policy leaving = std::exchange(parameters_.grid.leaving, config::Policy::stop);
  const config::Guards guards = parameters_.guards;
  parameters_.guards.not_finite = parameters_.guards.volume = config::Policy::stop;
  const double dt = parameters_.time.stepping == config::Stepping::fixed ? parameters_.time.step
                                                                         : parameters_.time.safety * step_limit().step;
  const auto steps = static_cast<std::int64_t>(std::ceil(parameters_.mechanics.settle_time / dt));
  for (std::int64_t k = 0; k < steps; ++k) {
    if (!may_continue()) {
      time_ = 0.0;  // no time of the run itself has been simulated
      step_number_ = 0;
      return false;
    }
    step(dt);
  }
  parameters_.grid.leaving = leaving;
  parameters_.guards = guards;
  release_device();
  // Assigns the settled stress to the particles as seeded, so nothing else of the settling remains.
  std::vector<SymmetricTensor<Real>> settled(particles_.size());
  for (std::size_t p = 0; p < particles_.size(); ++p) {
    settled[static_cast<std::size_t>(particles_.id(p))] = mpm::full_tensor<Dim>(particles_.stress, p);
  }
  model_ = model;
  seed();
  for (std::size_t p = 0; p < particles_.size(); ++p) {
    for (int c = 0; c < mpm::Particles<Dim>::tensor_components; ++c) {
      particles_.stress(p, c) = settled[static_cast<std::size_t>(particles_.id(p))][c];
    }
  }
  begin();
  return true;
}

#define THAWSLIDE_INSTANTIATE(Dim)                       \
  template bool Simulation<Dim>::needs_settling() const; \
  template bool Simulation<Dim>::settle(const std::function<bool()>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
