// Size of the next step, and the message if it is too small.
#include <algorithm>
#include <cmath>

#include "base/instances.hpp"
#include "base/rounding.hpp"
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
StepLimit Simulation<Dim>::step_limit() const {
  return sim::step_limit(setup_.parameters, setup_.model, setup_.band_thickness(clock_.time), solver().extremes());
}

template <int Dim>
double Simulation<Dim>::adaptive_step() const {
  const config::Time& times = setup_.parameters.time;
  const double dt = times.safety * largest_stable_step(setup_.parameters, setup_.model,
                                                       setup_.band_thickness(clock_.time), solver().extremes());
  return times.step > 0.0 ? std::min(dt, times.step) : dt;
}

template <int Dim>
double Simulation<Dim>::next_step(double until) {
  const config::Time& times = setup_.parameters.time;
  if (!setup_.is_adaptive()) {
    const double left = times.end - clock_.time;  // the last step may be shorter
    return left > (1.0 - round_off) * times.step ? times.step : left;
  }
  solver().start();  // so that the step after a restart follows from extremes of the device, as without one
  const double dt = adaptive_step();
  stop_if_step_collapses(dt);
  const double left = std::min(until, next_release(setup_.model.release_times, clock_.time)) - clock_.time;
  const double steps = std::ceil(left / dt * (1.0 - round_off));  // otherwise round-off adds one more step
  return left / std::max(1.0, steps);
}

template <int Dim>
void Simulation<Dim>::stop_if_step_collapses(double dt) const {
  const config::Guards& guards = setup_.parameters.guards;
  const double steps = (setup_.parameters.time.end - clock_.time) / dt;
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
    solver().sync_to_host();
    const std::size_t p = slide_->index_of(limit.particle);
    const mpm::Particles<Dim>& particles = slide_->particles;
    where = fmt::format(", of {}, whose volume is {:.3g} of that at t = 0", failure_text().name_of(p),
                        particles.volume(p) / particles.initial_volume(p));
  }
  fail_run(clock_, fmt::format("the next step would be {:.3g} s, {}. It is set by {}{}. {}", dt, why, limit.what, where,
                               advice_on(limit.kind, guards.volume == config::Policy::remove)));
}

#define THAWSLIDE_INSTANTIATE(Dim)                        \
  template StepLimit Simulation<Dim>::step_limit() const; \
  template double Simulation<Dim>::adaptive_step() const; \
  template double Simulation<Dim>::next_step(double);     \
  template void Simulation<Dim>::stop_if_step_collapses(double) const;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
