// One row of history.csv: what a run reports through time (ARCHITECTURE.md defines each column).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sim/simulation.hpp"

namespace thawslide::sim {

using HistoryRow = std::vector<std::pair<std::string, double>>;  // name, value

// What a row tells of the front [m].
struct FrontInRow {
  double position, runout;
};

// The state after the last step. The front is measured along x, or is the one handed over. Extensive values are per
// metre of width in 2D, times case.width if that is given.
template <int Dim, class Real>
HistoryRow history_row(const Simulation<Dim, Real>& simulation);
template <int Dim, class Real>
HistoryRow history_row(const Simulation<Dim, Real>& simulation, const FrontInRow& front);

// x up to which 99.5 % of the mass has come, in the direction in which the slide left [m].
template <int Dim, class Real>
double front_position(const Simulation<Dim, Real>& simulation);

}  // namespace thawslide::sim
