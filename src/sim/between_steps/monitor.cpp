#include "sim/between_steps/monitor.hpp"

#include <algorithm>
#include <cmath>

#include "base/instances.hpp"
#include "config/grounds.hpp"

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
  const double there = seen.kinetic + seen.potential + budget.stress_work + budget.pore_work + budget.left_mechanical;
  const double dissipated =
      budget.viscous + budget.damping + budget.friction_work + budget.contact_loss + budget.bed_work;
  const double came = budget.frame_work + budget.joined_mechanical + budget.initial_mechanical;
  return there + dissipated - came;
}

// Total energy so far: held by the material, kinetic or dissipated [J].
template <int Dim>
double energy_so_far(const Budget<Dim>& budget, const mpm::MonitorSums& seen, double energy_at_start) {
  return energy_at_start + (seen.kinetic + std::abs(budget.stress_work) + budget.viscous + budget.damping +
                            budget.friction_work + budget.contact_loss);
}

// True if the property of more than moving_fraction_at_rest of the mass exceeds a limit. of_particle(p): the property.
template <int Dim, class OfParticle>
bool exceeds(double limit, const mpm::Particles<Dim>& particles, const OfParticle& of_particle) {
  double mass = 0.0, above = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    mass += particles.mass(p);
    above += of_particle(p) > limit ? particles.mass(p) : 0.0;
  }
  return above > moving_fraction_at_rest * mass;
}

// Time for which a slide must be slow from the start to be at rest [s].
double rest_time_from_start(const config::Time& times, double gravity) {
  return std::min(times.rest_time, fall_times * rest_speed(times) / gravity);
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
mpm::MonitorKernel<Dim> monitor_kernel(const Setup<Dim>& setup, double dt) {
  // Displacement per step above which a particle is fast. Particle velocity also contains FLIP noise, which the grid
  // does not resolve and which displaces nothing.
  const double fast_distance = rest_speed(setup.parameters.time) * dt;
  const config::Guards& guards = setup.parameters.guards;
  return {setup.model.motion.gravity, setup.model.origin, fast_distance, guards.smallest_volume, guards.largest_volume};
}

template <int Dim>
RunMonitor monitor_at_start(const Setup<Dim>& setup, const Slide<Dim>& slide, const Budget<Dim>& budget,
                            const mpm::MonitorSums& seen) {
  RunMonitor monitor;
  for (const std::uint32_t p : slide.grid.order()) {
    const auto& material = setup.model.motion.materials[static_cast<std::size_t>(slide.particles.material(p))];
    const SymmetricTensor<double> stress = mpm::full_tensor<Dim>(slide.particles.stress, p);
    monitor.energy_at_start += slide.particles.volume(p) * physics::elastic_energy_density(material.elastic, stress);
  }
  monitor.lowest_made = energy_made(budget, seen);
  const auto speed = [&](std::size_t p) {
    return slide.particles.velocity.template get<Vector<double, Dim>>(p).norm();
  };
  monitor.rest_since = exceeds(rest_speed(setup.parameters.time), slide.particles, speed) ? -1.0 : 0.0;
  return monitor;
}

template <int Dim>
std::optional<EnergyGrowth> check_energy(const Setup<Dim>& setup, const Budget<Dim>& budget,
                                         const mpm::MonitorSums& seen, RunMonitor& monitor) {
  const double made = energy_made(budget, seen);
  monitor.lowest_made = std::min(made, monitor.lowest_made + forgotten_fraction * (made - monitor.lowest_made));
  monitor.largest_energy = std::max(monitor.largest_energy, energy_so_far(budget, seen, monitor.energy_at_start));
  const double growth = made - monitor.lowest_made;
  const double weight = seen.mass * setup.model.motion.gravity.norm();
  const double energy = std::max(monitor.largest_energy, weight * noticed_fall * setup.cell());
  const double round_off_of_sums = round_off_of_energy * std::abs(seen.potential);
  monitor.made_fraction = made > round_off_of_sums ? made / energy : 0.0;
  if (growth > setup.parameters.guards.energy_growth * energy + round_off_of_sums) {
    return EnergyGrowth{growth, growth / energy};
  }
  return {};
}

template <int Dim>
void update_rest(const Setup<Dim>& setup, double time, const mpm::MonitorSums& seen, const Solver<Dim>& solver,
                 const Slide<Dim>& slide, RunMonitor& monitor) {
  const config::Time& times = setup.parameters.time;
  const bool moves = seen.fast_mass > moving_fraction_at_rest * seen.mass;
  if (times.stop_at_rest <= 0.0) {
    monitor.has_moved = not_sampled;
  } else if (monitor.has_moved == not_sampled) {
    // The criterion of rest used another speed so far.
    monitor.rest_since = -1.0;
    solver.copy_particles_back();
    const auto moved = [&](std::size_t p) { return slide.particles.path_length(p); };
    monitor.has_moved = exceeds(times.moved_distance, slide.particles, moved) ? 1.0 : 0.0;
  }
  if (moves) {
    monitor.has_moved = times.stop_at_rest > 0.0 ? 1.0 : not_sampled;
    monitor.rest_since = -1.0;
  } else if (monitor.rest_since < 0.0) {
    monitor.rest_since = time;
  }
}

template <int Dim>
bool is_at_rest(const Setup<Dim>& setup, const Clock& clock, const RunMonitor& monitor) {
  const config::Time& times = setup.parameters.time;
  const double needed =
      monitor.rest_since > 0.0 ? times.rest_time : rest_time_from_start(times, setup.model.motion.gravity.norm());
  const double from = std::max(monitor.rest_since, last_event(setup.parameters, setup.model));
  return monitor.rest_since >= 0.0 && clock.step_number >= watch_interval && clock.time - from >= needed * (1.0 - 1e-9);
}

template <int Dim>
std::string rest_rule(const Setup<Dim>& setup) {
  const config::Time& times = setup.parameters.time;
  const double from_start = rest_time_from_start(times, setup.model.motion.gravity.norm());
  const std::string or_from_start =
      from_start < times.rest_time ? fmt::format(", or {:.2g} s from the start,", from_start) : "";
  const double event = last_event(setup.parameters, setup.model);
  const std::string after_event = event > 0.0 ? fmt::format(" after the last scheduled change at {:g} s", event) : "";
  return fmt::format("for {:g} s{}{} no more than {:g} % of the mass faster than {:g} m/s", times.rest_time,
                     or_from_start, after_event, 100.0 * moving_fraction_at_rest, rest_speed(times));
}

std::string rest_text(const config::Time& times, bool has_moved, const RunMonitor& monitor) {
  if (!has_moved) {
    return fmt::format("{}: no more than {:g} % of its mass has travelled {:g} m (time.moved_distance)", not_moved,
                       100.0 * mpm::fraction_ahead_of_front, times.moved_distance);
  }
  return fmt::format(
      "{}: since t = {:g} s no more than {:g} % of its mass has moved faster than {:g} m/s (time.stop_at_rest)",
      at_rest, monitor.rest_since, 100.0 * moving_fraction_at_rest, times.stop_at_rest);
}

std::string energy_warning(const config::Guards& guards, double time, const RunMonitor& monitor) {
  if (monitor.made_fraction <= guards.energy_growth) {
    return "";
  }
  return fmt::format(
      "warning: by t = {:.6g} s the time steps have created {:.3g} % of all energy, gradually and without a physical "
      "cause. The results from here on are not reliable. Set a larger viscosity_number or viscosity_time of the "
      "material, or a smaller time.step",
      time, 100.0 * monitor.made_fraction);
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                       \
  template mpm::MonitorKernel<Dim> monitor_kernel<Dim>(const Setup<Dim>&, double);                       \
  template RunMonitor monitor_at_start<Dim>(const Setup<Dim>&, const Slide<Dim>&, const Budget<Dim>&,    \
                                            const mpm::MonitorSums&);                                    \
  template std::optional<EnergyGrowth> check_energy<Dim>(const Setup<Dim>&, const Budget<Dim>&,          \
                                                         const mpm::MonitorSums&, RunMonitor&);          \
  template void update_rest<Dim>(const Setup<Dim>&, double, const mpm::MonitorSums&, const Solver<Dim>&, \
                                 const Slide<Dim>&, RunMonitor&);                                        \
  template bool is_at_rest<Dim>(const Setup<Dim>&, const Clock&, const RunMonitor&);                     \
  template std::string rest_rule<Dim>(const Setup<Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
