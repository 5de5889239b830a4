// Basal strength from the caller of a step, in place of the laws of the case: one call with all loaded nodes.
#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <vector>

#include "terrain/basal_law.hpp"

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

// Adds a node. position: Dim numbers.
template <int Dim>
void add_loaded_node(const double* position, const BasalNode& base, const BasalLaw& law, LoadedNodes& nodes) {
  nodes.position.insert(nodes.position.end(), position, position + Dim);
  nodes.area.push_back(base.area);
  nodes.substrate.push_back(base.substrate);
  nodes.normal_pressure.push_back(base.state.normal_pressure);
  nodes.pore_pressure.push_back(base.state.pore_pressure);
  nodes.temperature.push_back(base.state.temperature);
  nodes.saturation.push_back(base.state.saturation);
  nodes.solid_fraction.push_back(base.state.solid_fraction);
  nodes.slip.push_back(base.state.slip);
  nodes.speed.push_back(base.state.speed);
  nodes.unit_weight.push_back(base.state.unit_weight);
  nodes.strength.push_back(base.strength(law.clamp, law.cap_pressure));
}

// Called by the thread that performs the step, before the step changes particles.
using StrengthLaw = std::function<void(LoadedNodes&)>;

// Calls the law, which must keep the number of strengths.
inline void replace_strengths(const StrengthLaw& law, LoadedNodes& nodes) {
  const std::size_t count = nodes.strength.size();
  law(nodes);
  if (nodes.strength.size() != count) {
    throw std::logic_error("a basal law returned another number of strengths");
  }
}

}  // namespace thawslide::terrain
