// Basal strength from the caller of a step, in place of the laws of the case: one call with all loaded nodes.
#pragma once

#include <functional>
#include <vector>

#include "base/portability.hpp"

namespace thawslide::terrain {

// Loaded contact nodes of a step, one array per quantity. Their order is that of the blocks and of the nodes in a
// block, independent of the number of threads. Quantities are those of BasalNode.
struct LoadedNodes {
  double time = 0, dt = 0;       // begin and duration of the step [s]
  std::vector<double> position;  // Dim numbers per node [m], relative to the domain's lower corner
  std::vector<double> area;      // of contact [m2]
  std::vector<int> substrate;
  std::vector<double> normal_pressure, pore_pressure, temperature, saturation, solid_fraction, slip, speed, unit_weight;
  std::vector<double> strength;  // of the case's laws [Pa]; the law of the caller replaces the values
};

// Called by the thread that performs the step, before the step changes particles.
using StrengthLaw = std::function<void(LoadedNodes&)>;

}  // namespace thawslide::terrain
