// Warnings of a base too hot to be physically credible.
#pragma once

#include <string>

#include "sim/simulation.hpp"

namespace thawslide::app {

// Reports once each that water would boil but does not, and that band columns are hot or have boiled dry.
class BoilingWatch {
 public:
  // Returns a new warning; empty if there is none.
  template <int Dim>
  std::string warning(const sim::Simulation<Dim>& simulation);

 private:
  bool is_hot_ = false, is_dry_ = false;  // already reported
};

}  // namespace thawslide::app
