// Stability limits of the time step.
#pragma once

#include <string>

#include "band/step_extremes.hpp"
#include "config/case.hpp"
#include "mpm/particles.hpp"
#include "sim/setup/model.hpp"

namespace thawslide::sim {

// Causes of a limit on the step.
enum class LimitKind { none, wave, viscosity, particle_speed, conduction, seepage };

// Limit on the step [s] and its cause.
struct StepLimit {
  double step;
  std::string what;
  LimitKind kind = LimitKind::none;
  std::int64_t particle = -1;  // id of the limiting particle; negative if there is none
};

// Extremes over particles that set limits. Allocates nothing, because adaptive steps call it every time.
template <int Dim>
band::StepExtremes extremes_of(const Model<Dim>& model, const mpm::Particles<Dim>& particles);

// Minimum of the limits by wave speed (with viscosity), particle speed, heat conduction and seepage [s].
template <int Dim>
double largest_stable_step(const config::Case& parameters, const Model<Dim>& model, double thickness,
                           const band::StepExtremes& extremes);

// The same, with its cause.
template <int Dim>
StepLimit step_limit(const config::Case& parameters, const Model<Dim>& model, double thickness,
                     const band::StepExtremes& extremes);

}  // namespace thawslide::sim
