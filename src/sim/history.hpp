// One row of history.csv: what a run reports through time (ARCHITECTURE.md defines each column).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sim/simulation.hpp"

namespace thawslide::sim {

using HistoryRow = std::vector<std::pair<std::string, double>>;  // name, value

// The state after the last step. Extensive values are per metre of width in 2D, times case.width if that is given.
template <int Dim, class Real>
HistoryRow history_row(const Simulation<Dim, Real>& simulation);

// x behind which 99.5 % of the mass lies [m].
template <int Dim, class Real>
double front_position(const Simulation<Dim, Real>& simulation);

}  // namespace thawslide::sim
