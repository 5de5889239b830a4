// Warnings of a base too hot to be physically credible.
#pragma once

#include <string>

#include "sim/simulation.hpp"

namespace thawslide::app {

// Reports that water would boil but does not, that band columns are hot or have boiled dry, and each time that the base
// passes a higher limit of temperature.
class BoilingWatch {
 public:
  // Returns a new warning; empty if there is none.
  template <int Dim>
  std::string warning(const sim::Simulation<Dim>& simulation);

 private:
  bool is_dry_ = false;        // already reported
  double passed_limit_ = 0.0;  // highest limit already reported [C]
};

}  // namespace thawslide::app
