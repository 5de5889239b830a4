// What a run says once, where the base gets too hot to be believed.
#pragma once

#include <string>

#include "sim/simulation.hpp"

namespace thawslide::app {

// A note where water would boil and does not, or band columns have boiled dry; empty where neither holds.
template <int Dim>
std::string note_on_boiling(const sim::Simulation<Dim, double>& simulation);

}  // namespace thawslide::app
