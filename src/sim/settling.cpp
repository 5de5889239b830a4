// Settling: gravity is applied before t = 0, with damping and on a fixed base.
#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

template <int Dim>
bool Simulation<Dim>::settle(const std::function<bool()>& may_continue) {
  if (!needs_settling()) {
    return true;
  }
  THAWSLIDE_ASSERT(slide_->particles.size() == static_cast<std::size_t>(slide_->next_id),
                   "{} particles joined before the settling",
                   static_cast<std::size_t>(slide_->next_id) - slide_->count_at_start);
  solver().release();
  const Model<Dim> model = setup_.model;
  setup_.model.band.heat = setup_.model.band.pressure = false;
  std::erase_if(setup_.model.constraints.conditions, [](const auto& condition) {
    return std::visit([](const auto& of_kind) { return of_kind.moves; }, condition);
  });
  setup_.model.release_times.clear();  // all bodies settle together
  setup_.model.splits_stretched = false;
  setup_.model.contact.base_is_fixed = true;
  setup_.model.contact.band_columns = false;
  base_.columns.reset();
  setup_.model.contact.mass_damping = setup_.parameters.mechanics.settle_damping;
  // No particle may leave.
  const config::Policy leaving = std::exchange(setup_.parameters.grid.leaving, config::Policy::stop);
  const config::Guards guards = setup_.parameters.guards;
  setup_.parameters.guards.not_finite = setup_.parameters.guards.volume = config::Policy::stop;
  const double dt = setup_.parameters.time.stepping == config::Stepping::fixed
                        ? setup_.parameters.time.step
                        : setup_.parameters.time.safety * step_limit().step;
  const auto steps = static_cast<std::int64_t>(std::ceil(setup_.parameters.mechanics.settle_time / dt));
  for (std::int64_t k = 0; k < steps; ++k) {
    if (!may_continue()) {
      clock_ = {};  // no time of the run itself has been simulated
      return false;
    }
    step(dt);
  }
  setup_.parameters.grid.leaving = leaving;
  setup_.parameters.guards = guards;
  solver().release();
  // Assigns the settled stress to the particles as seeded, so nothing else of the settling remains.
  std::vector<SymmetricTensor<double>> settled(slide_->particles.size());
  for (std::size_t p = 0; p < slide_->particles.size(); ++p) {
    settled[static_cast<std::size_t>(slide_->particles.id(p))] = mpm::full_tensor<Dim>(slide_->particles.stress, p);
  }
  setup_.model = model;
  seed();
  for (std::size_t p = 0; p < slide_->particles.size(); ++p) {
    for (int c = 0; c < mpm::tensor_components<Dim>; ++c) {
      slide_->particles.stress(p, c) = settled[static_cast<std::size_t>(slide_->particles.id(p))][c];
    }
  }
  begin();
  return true;
}

template bool Simulation<2>::settle(const std::function<bool()>&);
template bool Simulation<3>::settle(const std::function<bool()>&);

}  // namespace thawslide::sim
