// Bodies that stand apart at t = 0 and share nodes all the same, which is most likely not meant.
#pragma once

#include <string>

#include "sim/simulation.hpp"

namespace thawslide::sim {

// For a simulation that has not taken a step. Empty: nothing is to be said, as where the case names
// contact.between_bodies.
template <int Dim>
[[nodiscard]] std::string warning_of_bodies_apart(const Simulation<Dim, double>& simulation);

}  // namespace thawslide::sim
