// Facts about a case before it runs: unusual or probably unintended values, and the estimated run time.
#pragma once

#include "run/warnings.hpp"
#include "sim/body_figures.hpp"

namespace thawslide::run {

// Requires a simulation before its first step.
template <int Dim>
void add_setup_warnings(const sim::Simulation<Dim>& simulation, const std::vector<sim::BodyFigures>& bodies,
                        Warnings& warnings);

// Number of steps of a run if all are as long as the first one.
template <int Dim>
[[nodiscard]] double steps_to_end(sim::Simulation<Dim>& simulation);

// Wall-clock seconds per step, measured on some steps, which advance the simulation.
template <int Dim>
[[nodiscard]] double measured_step_seconds(sim::Simulation<Dim>& simulation);

}  // namespace thawslide::run
