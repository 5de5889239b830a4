// Warns of bodies that are separate at t = 0 but share nodes, which is probably unintended.
#pragma once

#include <string>

#include "sim/simulation.hpp"

namespace thawslide::sim {

// Requires a simulation before its first step. Returns an empty string if there is nothing to report, also if the case
// specifies contact.between_bodies.
template <int Dim>
[[nodiscard]] std::string warning_of_bodies_apart(const Simulation<Dim>& simulation);

}  // namespace thawslide::sim
