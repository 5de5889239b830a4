// Where the steps of a run are taken: --device.
#pragma once

#include <string>

#include "sim/simulation.hpp"

namespace thawslide::app {

// A card that this program can use.
struct GpuFacts {
  std::string name;
  std::string why_not;   // no card takes the steps; empty: this one does
  double free = 0.0;     // memory before the run [bytes]
  double used = 0.0;     // by the run after its first steps [bytes]
  double seconds = 0.0;  // of wall time that the run takes, from the first steps
};
[[nodiscard]] GpuFacts detect_gpu();

// Steps on a card where that is asked for: "gpu", or "auto" where there is a card and the run needs nothing that no
// device does yet; "cpu" changes nothing. Returns where they are taken, in words; empty: on the processor. Throws
// UserError for a card that is not there, with the reason, and for what it does not do.
template <int Dim>
std::string use_device(const std::string& device, sim::Simulation<Dim, double>& simulation);

}  // namespace thawslide::app
