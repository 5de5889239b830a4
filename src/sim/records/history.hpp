// One row of history.csv (output_columns.cpp describes each column).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sim/simulation.hpp"

namespace thawslide::sim {

using HistoryRow = std::vector<std::pair<std::string, double>>;  // name, value

// Front of a row [m].
struct FrontInRow {
  double position, runout;
};

// State after the last step. The front is measured along x, or given by the caller. In 2D, extensive values are per
// metre of width, times case.width if specified.
template <int Dim>
HistoryRow history_row(const Simulation<Dim>& simulation);
template <int Dim>
HistoryRow history_row(const Simulation<Dim>& simulation, const FrontInRow& front);

// x coordinate of the front (99.5 % of the mass), in the direction in which the slide left [m].
template <int Dim>
double front_position(const Simulation<Dim>& simulation);

}  // namespace thawslide::sim
