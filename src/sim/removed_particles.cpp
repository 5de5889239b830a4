// Handling of particles that are invalid, or have left the domain or the known terrain: they end the run, or are
// removed and counted, as specified by the case.
#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/instances.hpp"
#include "base/parallel.hpp"
#include "base/rounding.hpp"
#include "device/solver.hpp"
#include "sim/simulation.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::sim {

namespace {

// Reason for removal of a particle.
enum Mark : std::uint8_t { stays, has_left, is_not_finite, has_inverted };

Mark mark_of(mpm::Fault fault, const config::Guards& guards) {
  switch (fault) {
    case mpm::Fault::volume_not_finite:
    case mpm::Fault::state_not_finite:
      return guards.not_finite == config::Policy::remove ? is_not_finite : stays;
    case mpm::Fault::volume_not_positive:
    case mpm::Fault::volume_too_small:
    case mpm::Fault::volume_too_large:
      return guards.volume == config::Policy::remove ? has_inverted : stays;
    case mpm::Fault::left_domain:
    case mpm::Fault::left_map:
    case mpm::Fault::none:
      break;
  }
  return stays;
}

// Fault of a single particle after a step.
template <int Dim>
mpm::Fault fault_of(const mpm::Particles<Dim>& particles, std::size_t p, const config::Guards& guards) {
  const Real volume = particles.volume(p);
  if (!std::isfinite(volume)) {
    return mpm::Fault::volume_not_finite;
  }
  Real state = particles.temperature(p) + particles.pore_pressure(p) + particles.stress(p, 0);
  for (int a = 0; a < Dim; ++a) {
    state += particles.step_displacement(p, a);
  }
  if (!std::isfinite(state)) {
    return mpm::Fault::state_not_finite;
  }
  const auto ratio = static_cast<double>(volume / particles.initial_volume(p));
  if (ratio <= 0.0) {
    return mpm::Fault::volume_not_positive;
  }
  if (ratio < guards.smallest_volume) {
    return mpm::Fault::volume_too_small;
  }
  return ratio > guards.largest_volume ? mpm::Fault::volume_too_large : mpm::Fault::none;
}

// Marks particles outside the domain.
template <int Dim>
void mark_left_domain(const mpm::Particles<Dim>& particles, const Vector<Real, Dim>& extent,
                      std::vector<std::uint8_t>& marks) {
  constexpr std::size_t of_a_task = 1024;
  parallel_for((marks.size() + of_a_task - 1) / of_a_task, [&](std::size_t task) {
    for (std::size_t p = task * of_a_task; p < std::min(marks.size(), (task + 1) * of_a_task); ++p) {
      for (int a = 0; a < Dim && marks[p] == stays; ++a) {
        if (particles.position(p, a) < Real(0) || particles.position(p, a) > extent[a]) {
          marks[p] = has_left;
        }
      }
    }
  });
}

std::int64_t count_of(const std::vector<std::uint8_t>& marks, Mark mark) {
  return std::count(marks.begin(), marks.end(), std::uint8_t{mark});
}

}  // namespace

// Sets invalid_ to the fault that must end the run.
template <int Dim>
void Simulation<Dim>::mark_invalid_particles() {
  const config::Guards& guards = parameters_.guards;
  marks_.clear();
  if (invalid_.id < 0 || mark_of(invalid_.fault, guards) == stays) {
    return;
  }
  invalid_ = {};
  marks_.assign(particles_.size(), stays);
  for (std::size_t p = 0; p < particles_.size(); ++p) {
    const mpm::Fault fault = fault_of(particles_, p, guards);
    marks_[p] = mark_of(fault, guards);
    if (fault != mpm::Fault::none && marks_[p] == stays) {
      invalid_.record(particles_.id(p), fault);
    }
  }
}

template <int Dim>
void Simulation<Dim>::mark_left_particles() {
  const bool removes = parameters_.grid.leaving == config::Policy::remove;
  if (removes) {
    marks_.resize(particles_.size(), stays);
    mark_left_domain<Dim>(particles_, model_.constraints.extent, marks_);
  }
  const std::size_t tiles = model_.ground ? grid_.tiles().size() : 0;
  invalid_ += parallel_sum<mpm::InvalidParticle>(tiles, [&](std::size_t t, mpm::InvalidParticle& invalid) {
    // The tile's own block is the middle one of its stencil, and its ground is checked one cell beyond its edge. After
    // device steps the tiles may be outdated, so all particles are checked.
    const auto own = static_cast<std::size_t>(grid_.blocks_about_tile(t)[mpm::Tile<Dim>::stencil / 2]);
    if (!device_solver_ && !ground_->partly_unknown(own)) {
      return;
    }
    for (std::uint32_t k = grid_.tiles()[t].first; k < grid_.tiles()[t].last; ++k) {
      const std::uint32_t p = grid_.order()[k];
      const auto position = particles_.position.template get<Vector<Real, Dim - 1>>(p).template cast<double>();
      if (model_.ground->is_known(position) || (!marks_.empty() && marks_[p] != stays)) {
        continue;
      }
      if (removes) {
        marks_[p] = has_left;
      } else {
        invalid.record(particles_.id(p), mpm::Fault::left_map);
      }
    }
  });
}

// Adds the budget terms of the marked particles. For a non-finite particle, only mass and position are known; the
// residuals of the other terms show its content.
template <int Dim>
void Simulation<Dim>::add_removed_particles() {
  std::vector<std::uint8_t> known = marks_;
  for (const std::uint32_t p : grid_.order()) {
    if (marks_[p] == is_not_finite) {
      known[p] = stays;
      budget_.left_mass += particles_.mass(p);
      budget_.left_mechanical -= particles_.mass(p) * model_.motion.gravity.dot(position_of(p).template cast<Real>());
    }
    budget_.removed_mass += marks_[p] == is_not_finite || marks_[p] == has_inverted ? particles_.mass(p) : Real(0);
  }
  const BodySums<Dim> sums = sum_over_marked(known);
  budget_.left_mass += sums.mass;
  budget_.left_mechanical += sums.kinetic + sums.potential;
  budget_.left_thermal += sums.sensible + sums.latent;
  budget_.left_momentum += sums.momentum;
  budget_.left_seeped += sums.seeped;
}

// The effect of a step with a non-finite particle is unknown as well, so its budget terms stay unchanged.
template <int Dim>
void Simulation<Dim>::correct_energy_for_removal() {
  std::vector<Real> before;
  budget_before_.for_each([&](const Real& term) { before.push_back(term); });
  std::size_t k = 0;
  budget_.for_each([&](Real& term) {
    term = std::isfinite(term) ? term : before[k];
    ++k;
  });
}

// Reports the particle with the smallest id among those marked last as invalid.
template <int Dim>
void Simulation<Dim>::stop_for_removed_mass(double fraction) {
  for (std::size_t p = 0; p < particles_.size(); ++p) {
    if (marks_[p] == is_not_finite || marks_[p] == has_inverted) {
      invalid_.record(particles_.id(p), fault_of(particles_, p, parameters_.guards));
    }
  }
  const std::size_t last = index_in_memory(invalid_.id);
  throw RunError(
      fmt::format("the run failed at t = {:.6g} s (step {}): [guards] has removed {}, {:.3g} % of all mass, where "
                  "guards.removed_mass allows {:g} %; among the last: {}: {}. {}",
                  time_, step_number_, text_of(removed_), 100.0 * fraction, 100.0 * parameters_.guards.removed_mass,
                  particle_text(last), fault_text(last), likely_cause(last)));
}

template <int Dim>
void Simulation<Dim>::remove_marked_particles() {
  const Removed now{count_of(marks_, has_left), count_of(marks_, is_not_finite), count_of(marks_, has_inverted)};
  if (now.left + now.by_guards() == 0) {
    return;
  }
  const bool none_stays = static_cast<std::size_t>(now.left + now.by_guards()) == particles_.size();
  if (none_stays && now.by_guards() == 0) {
    throw SlideLeft(fmt::format(
        "the whole slide has left the domain or the known terrain at t = {:.6g} s (step {}). mass_kg still includes "
        "the last {} kg{}, which left in this step. Specify a larger domain ([grid] min and max) or a larger DEM, "
        "and repeat the run.",
        time_, step_number_, rounded_text(static_cast<double>(sum_over_body().mass), 3),
        Dim == 2 ? " per m of width" : ""));
  }
  if (now.not_finite > 0) {
    correct_energy_for_removal();
  }
  add_removed_particles();
  removed_.left += now.left;
  removed_.not_finite += now.not_finite;
  removed_.volume += now.volume;
  const auto all_mass = static_cast<double>(budget_.initial_mass + budget_.joined_mass);
  const double fraction = static_cast<double>(budget_.removed_mass) / all_mass;
  if (none_stays || fraction > parameters_.guards.removed_mass) {
    stop_for_removed_mass(fraction);
  }
  release_device();
  grid_.remove(particles_, particles_.remove(marks_));
  update_ground();
}

#define THAWSLIDE_INSTANTIATE(Dim)                              \
  template void Simulation<Dim>::mark_invalid_particles();      \
  template void Simulation<Dim>::mark_left_particles();         \
  template void Simulation<Dim>::add_removed_particles();       \
  template void Simulation<Dim>::correct_energy_for_removal();  \
  template void Simulation<Dim>::stop_for_removed_mass(double); \
  template void Simulation<Dim>::remove_marked_particles();
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
