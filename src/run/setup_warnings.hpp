// Facts about a case before it runs: unusual or probably unintended values.
#pragma once

#include "run/warnings.hpp"
#include "sim/checks/body_figures.hpp"

namespace thawslide::run {

// Requires a simulation before its first step.
template <int Dim>
void add_setup_warnings(const sim::Simulation<Dim>& simulation, const std::vector<sim::BodyFigures>& bodies,
                        Warnings& warnings);

}  // namespace thawslide::run
