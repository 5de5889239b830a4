// Size of the next step, and the message if it is too small.
#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/instances.hpp"
#include "base/rounding.hpp"
#include "device/solver.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

namespace {

// Advice on a limit that has fallen to a small fraction of its initial value.
std::string advice_on(LimitKind kind, bool removes) {
  const std::string remove = removes ? "emove such particles with a smaller guards.largest_volume."
                                     : "emove such particles with guards.volume = \"remove\" and a "
                                       "guards.largest_volume.";
  switch (kind) {
    case LimitKind::wave:
      return "Waves are faster in lighter material: the particle has expanded. R" + remove;
    case LimitKind::viscosity:
      return "Try a smaller viscosity_number or viscosity_time of the material. Its limit falls with the square of the "
             "wave speed, which grows in separated material. Alternatively, r" +
             remove;
    case LimitKind::particle_speed:
      return "The particle detached from the flow, or the run became unstable: try half of time.safety, or a larger "
             "viscosity_number or viscosity_time of the material.";
    case LimitKind::conduction:
    case LimitKind::seepage:
      return "The band has become thin, or its hydraulic conductivity is large: try a larger band.thickness, or "
             "band.model = \"columns\", whose steps have no such limit.";
    case LimitKind::none:
      break;
  }
  return "";
}

}  // namespace

template <int Dim>
void Simulation<Dim>::locate_particles() const {
  if (model_.ground && !are_particles_located_) {
    model_.ground->locate(particles_);
    are_particles_located_ = true;
  }
}

template <int Dim>
band::StepExtremes Simulation<Dim>::extremes() const {
  const bool are_on_device = device_solver_ && parameters_.time.stepping == config::Stepping::adaptive;
  if (are_on_device) {
    return device_sums_->extremes;
  }
  locate_particles();
  return extremes_of(model_, particles());
}

template <int Dim>
StepLimit Simulation<Dim>::step_limit() const {
  return sim::step_limit(parameters_, model_, band_thickness(), extremes());
}

template <int Dim>
double Simulation<Dim>::adaptive_step() const {
  const double dt = parameters_.time.safety * largest_stable_step(parameters_, model_, band_thickness(), extremes());
  return parameters_.time.step > 0.0 ? std::min(dt, parameters_.time.step) : dt;
}

template <int Dim>
double Simulation<Dim>::next_step(double until) {
  if (parameters_.time.stepping == config::Stepping::fixed) {
    const double left = parameters_.time.end - time_;  // the last step may be shorter
    return left > (1.0 - round_off) * parameters_.time.step ? parameters_.time.step : left;
  }
  start_on_device();  // so that the step after a restart follows from extremes of the device, as without one
  const double dt = adaptive_step();
  stop_if_step_collapses(dt);
  const double left = std::min(until, next_release()) - time_;
  const double steps = std::ceil(left / dt * (1.0 - round_off));  // otherwise round-off adds one more step
  return left / std::max(1.0, steps);
}

template <int Dim>
void Simulation<Dim>::stop_if_step_collapses(double dt) const {
  const config::Guards& guards = parameters_.guards;
  const double steps = (parameters_.time.end - time_) / dt;
  std::string why;
  if (dt < guards.smallest_step * monitor_.first_step) {
    why = fmt::format("{:.2g} of the first one, {:.3g} s, where guards.smallest_step allows {:g}",
                      dt / monitor_.first_step, monitor_.first_step, guards.smallest_step);
  } else if (steps > guards.most_steps) {
    why = fmt::format("and {} of them would be left to time.end, where guards.most_steps allows {}",
                      rounded_text(steps, 2), count_text(guards.most_steps));
  } else {
    return;
  }
  const StepLimit limit = step_limit();
  std::string where;
  if (limit.particle >= 0) {
    sync_to_host();
    const std::size_t p = index_in_memory(limit.particle);
    where = fmt::format(", of {}, whose volume is {:.3g} of that at t = 0", particle_text(p),
                        static_cast<double>(particles_.volume(p) / particles_.initial_volume(p)));
  }
  throw RunError(
      fmt::format("the run failed at t = {:.6g} s (step {}): the next step would be {:.3g} s, {}. It is set "
                  "by {}{}. {}",
                  time_, step_number_, dt, why, limit.what, where,
                  advice_on(limit.kind, parameters_.guards.volume == config::Policy::remove)));
}

#define THAWSLIDE_INSTANTIATE(Dim)                               \
  template void Simulation<Dim>::locate_particles() const;       \
  template band::StepExtremes Simulation<Dim>::extremes() const; \
  template StepLimit Simulation<Dim>::step_limit() const;        \
  template double Simulation<Dim>::adaptive_step() const;        \
  template double Simulation<Dim>::next_step(double);            \
  template void Simulation<Dim>::stop_if_step_collapses(double) const;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
