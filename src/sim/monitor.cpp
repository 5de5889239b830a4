// Monitor of a run: unexplained energy growth, volume limits, and rest.
#include "sim/monitor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "base/instances.hpp"
#include "config/scheduled_events.hpp"
#include "device/solver.hpp"
#include "mpm/sum_over_particles.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

namespace {

// Round-off of sums over particles, relative to their largest term, the potential energy.
constexpr double round_off_of_energy = 1e-10;

// Lower bound of the reference energy, as the energy of a fall by this number of cells. A body almost at rest has so
// little energy that discretization errors are a large fraction of it. An instability exceeds the bound within some
// steps.
constexpr double noticed_fall = 1.0;

// Fraction by which the reference level relaxes to the current energy at each check. An instability grows within a few
// hundred steps. The slow gains of a body at rest for a long time, which contact dissipates again, do not count.
constexpr double forgotten_fraction = 0.02;

// Speed below which the slide is at rest [m/s]: time.stop_at_rest, if specified.
double rest_speed(const config::Time& times) {
  return times.stop_at_rest > 0.0 ? times.stop_at_rest : usual_rest_speed;
}

// A slide that is slow from the start is at rest after this multiple of the free-fall time to the rest speed. A mass
// that accelerates at a fiftieth of gravity exceeds that speed by then.
constexpr double fall_times = 50.0;

// Value of RunMonitor::has_moved in a run that does not stop at rest.
constexpr double not_sampled = -1.0;

// Energy present or accounted for, minus energy supplied [J]: the energy gained or lost by the transfers and the time
// steps. It is the sum of mechanical_residual_J and numerical_J of the history, which compensate each other in a stable
// run.
template <int Dim>
double energy_made(const Budget<Dim>& budget, const mpm::MonitorSums& seen) {
  const Real there = seen.kinetic + seen.potential + budget.stress_work + budget.pore_work + budget.left_mechanical;
  const Real dissipated =
      budget.viscous + budget.damping + budget.friction_work + budget.contact_loss + budget.bed_work;
  const Real came = budget.frame_work + budget.joined_mechanical + budget.initial_mechanical;
  return static_cast<double>(there + dissipated - came);
}

// Total energy so far: held by the material, kinetic or dissipated [J].
template <int Dim>
double energy_so_far(const Budget<Dim>& budget, const mpm::MonitorSums& seen, double energy_at_start) {
  return energy_at_start + static_cast<double>(seen.kinetic + std::abs(budget.stress_work) + budget.viscous +
                                               budget.damping + budget.friction_work + budget.contact_loss);
}

// True if more than moving_fraction_at_rest of the mass moves faster than `speed` [m/s].
template <int Dim>
bool starts_faster(const mpm::Particles<Dim>& particles, double speed) {
  double mass = 0.0, fast_mass = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const auto velocity = particles.velocity.template get<Vector<Real, Dim>>(p);
    mass += static_cast<double>(particles.mass(p));
    fast_mass += static_cast<double>(velocity.norm()) > speed ? static_cast<double>(particles.mass(p)) : 0.0;
  }
  return fast_mass > moving_fraction_at_rest * mass;
}

// Time for which a slide must be slow from the start to be at rest [s].
double rest_time_from_start(const config::Time& times, double gravity) {
  return std::min(times.rest_time, fall_times * rest_speed(times) / gravity);
}

// True if more than moving_fraction_at_rest of the mass has moved farther than a distance [m].
template <int Dim>
bool has_moved_further(const mpm::Particles<Dim>& particles, Real distance) {
  Real mass = 0, far_mass = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    mass += particles.mass(p);
    far_mass += particles.path_length(p) > distance ? particles.mass(p) : Real(0);
  }
  return far_mass > static_cast<Real>(moving_fraction_at_rest) * mass;
}

// Time of the last scheduled change of the case, or of the last release [s].
template <int Dim>
double last_event(const config::Case& parameters, const Model<Dim>& model) {
  double last = config::last_scheduled_event(parameters);
  for (const double time : model.release_times) {
    last = std::max(last, time);
  }
  return last;
}

}  // namespace

template <int Dim>
mpm::MonitorSums Simulation<Dim>::monitor_sums() const {
  // Displacement per step above which a particle is fast. Particle velocity also contains FLIP noise, which the grid
  // does not resolve and which displaces nothing.
  const Real fast_distance = static_cast<Real>(rest_speed(parameters_.time)) * dt_;
  const mpm::MonitorKernel<Dim> kernel{model_.motion.gravity, model_.origin.template cast<Real>(), fast_distance,
                                       static_cast<Real>(parameters_.guards.smallest_volume),
                                       static_cast<Real>(parameters_.guards.largest_volume)};
  mpm::MonitorSums seen;
  if (device_solver_) {
    on_device([&] { seen = device_solver_->monitor(kernel); });
    return seen;
  }
  return mpm::sum_over_particles<mpm::MonitorSums>(grid_, [&](std::uint32_t p) { return kernel(particles_, p); });
}

template <int Dim>
void Simulation<Dim>::start_monitor() {
  monitor_ = {};
  removed_ = {};
  monitor_.first_step = parameters_.time.stepping == config::Stepping::adaptive ? adaptive_step() : 0.0;
  if (!parameters_.mechanics.enabled) {
    return;
  }
  for (const std::uint32_t p : grid_.order()) {
    const auto& material = model_.motion.materials[static_cast<std::size_t>(particles_.material(p))];
    const SymmetricTensor<Real> stress = mpm::full_tensor<Dim>(particles_.stress, p);
    monitor_.energy_at_start +=
        static_cast<double>(particles_.volume(p) * physics::elastic_energy_density(material.elastic, stress));
  }
  monitor_.lowest_made = energy_made(budget_, monitor_sums());
  monitor_.rest_since = starts_faster(particles_, rest_speed(parameters_.time)) ? -1.0 : 0.0;
}

template <int Dim>
void Simulation<Dim>::monitor() {
  if (!parameters_.mechanics.enabled || (step_number_ % watch_interval != 0 && invalid_.id < 0)) {
    return;
  }
  const mpm::MonitorSums seen = monitor_sums();
  stop_if_energy_grows(seen);
  invalid_ += seen.volumes;
  update_rest(seen);
}

template <int Dim>
void Simulation<Dim>::stop_if_energy_grows(const mpm::MonitorSums& seen) {
  const double made = energy_made(budget_, seen);
  monitor_.lowest_made = std::min(made, monitor_.lowest_made + forgotten_fraction * (made - monitor_.lowest_made));
  monitor_.largest_energy = std::max(monitor_.largest_energy, energy_so_far(budget_, seen, monitor_.energy_at_start));
  const double growth = made - monitor_.lowest_made;
  const double weight = static_cast<double>(seen.mass * model_.motion.gravity.norm());
  const double energy = std::max(monitor_.largest_energy, weight * noticed_fall * parameters_.grid.cell);
  const double round_off_of_sums = round_off_of_energy * static_cast<double>(std::abs(seen.potential));
  monitor_.made_fraction = made > round_off_of_sums ? made / energy : 0.0;
  if (growth > parameters_.guards.energy_growth * energy + round_off_of_sums) {
    stop_for_energy(growth, growth / energy);
  }
}

template <int Dim>
void Simulation<Dim>::update_rest(const mpm::MonitorSums& seen) {
  const bool moves = seen.fast_mass > static_cast<Real>(moving_fraction_at_rest) * seen.mass;
  if (parameters_.time.stop_at_rest <= 0.0) {
    monitor_.has_moved = not_sampled;
  } else if (monitor_.has_moved == not_sampled) {
    // The criterion of rest used another speed so far.
    monitor_.rest_since = -1.0;
    monitor_.has_moved =
        has_moved_further(std::as_const(*this).particles(), static_cast<Real>(parameters_.time.moved_distance)) ? 1.0
                                                                                                                : 0.0;
  }
  if (moves) {
    monitor_.has_moved = parameters_.time.stop_at_rest > 0.0 ? 1.0 : not_sampled;
    monitor_.rest_since = -1.0;
  } else if (monitor_.rest_since < 0.0) {
    monitor_.rest_since = time_;
  }
}

template <int Dim>
bool Simulation<Dim>::is_at_rest() const {
  const config::Time& times = parameters_.time;
  const double needed = monitor_.rest_since > 0.0
                            ? times.rest_time
                            : rest_time_from_start(times, static_cast<double>(model_.motion.gravity.norm()));
  const double from = std::max(monitor_.rest_since, last_event(parameters_, model_));
  return monitor_.rest_since >= 0.0 && step_number_ >= watch_interval && time_ - from >= needed * (1.0 - 1e-9);
}

template <int Dim>
bool Simulation<Dim>::ends_at_rest() const {
  return parameters_.time.stop_at_rest > 0.0 && monitor_.has_moved > 0.0 && is_at_rest();
}

template <int Dim>
std::string Simulation<Dim>::rest_rule() const {
  const config::Time& times = parameters_.time;
  const double from_start = rest_time_from_start(times, static_cast<double>(model_.motion.gravity.norm()));
  const std::string or_from_start =
      from_start < times.rest_time ? fmt::format(", or {:.2g} s from the start,", from_start) : "";
  const double event = last_event(parameters_, model_);
  const std::string after_event = event > 0.0 ? fmt::format(" after the last scheduled change at {:g} s", event) : "";
  return fmt::format("for {:g} s{}{} no more than {:g} % of the mass faster than {:g} m/s", times.rest_time,
                     or_from_start, after_event, 100.0 * moving_fraction_at_rest, rest_speed(times));
}

template <int Dim>
void Simulation<Dim>::restart_rest_time() {
  monitor_.rest_since = -1.0;
}

template <int Dim>
std::string Simulation<Dim>::energy_warning() const {
  if (monitor_.made_fraction <= parameters_.guards.energy_growth) {
    return "";
  }
  return fmt::format(
      "warning: by t = {:.6g} s the time steps have created {:.3g} % of all energy, gradually and without a physical "
      "cause. The results from here on are not reliable. Set a larger viscosity_number or viscosity_time of the "
      "material, or a smaller time.step",
      time_, 100.0 * monitor_.made_fraction);
}

template <int Dim>
std::string Simulation<Dim>::rest_text() const {
  if (!moved_mass().has_moved) {
    return fmt::format("{}: no more than {:g} % of its mass has travelled {:g} m (time.moved_distance)", not_moved,
                       100.0 * mpm::fraction_ahead_of_front, parameters_.time.moved_distance);
  }
  return fmt::format(
      "{}: since t = {:g} s no more than {:g} % of its mass has moved faster than {:g} m/s (time.stop_at_rest)",
      at_rest, monitor_.rest_since, 100.0 * moving_fraction_at_rest, parameters_.time.stop_at_rest);
}

#define THAWSLIDE_INSTANTIATE(Dim)                                              \
  template mpm::MonitorSums Simulation<Dim>::monitor_sums() const;              \
  template void Simulation<Dim>::start_monitor();                               \
  template void Simulation<Dim>::monitor();                                     \
  template void Simulation<Dim>::stop_if_energy_grows(const mpm::MonitorSums&); \
  template void Simulation<Dim>::update_rest(const mpm::MonitorSums&);          \
  template bool Simulation<Dim>::is_at_rest() const;                            \
  template bool Simulation<Dim>::ends_at_rest() const;                          \
  template std::string Simulation<Dim>::rest_rule() const;                      \
  template std::string Simulation<Dim>::energy_warning() const;                 \
  template void Simulation<Dim>::restart_rest_time();                           \
  template std::string Simulation<Dim>::rest_text() const;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
