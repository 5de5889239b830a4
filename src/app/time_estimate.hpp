// How long a run takes, measured on its first steps.
#pragma once

#include "sim/simulation.hpp"

namespace thawslide::app {

// Seconds of wall time that one step takes now; takes some steps.
template <int Dim>
[[nodiscard]] double measured_step_seconds(sim::Simulation<Dim, double>& simulation);

}  // namespace thawslide::app
