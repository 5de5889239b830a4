// Warnings about initial states of bodies that are probably unintended.
#pragma once

#include <string>
#include <vector>

#include "sim/checks/body_figures.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

// Each warning specifies the location in the case, the finding and the remedy.
[[nodiscard]] std::vector<std::string> body_warnings(const config::Case& parameters,
                                                     const std::vector<BodyFigures>& bodies);

// Warns of bodies that are separate at t = 0 but share nodes, which is probably unintended. Requires a simulation
// before its first step. Returns an empty string if there is nothing to report, also if the case specifies
// contact.between_bodies.
template <int Dim>
[[nodiscard]] std::string warning_of_bodies_apart(const Simulation<Dim>& simulation);

}  // namespace thawslide::sim
