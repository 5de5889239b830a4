// Device of a run: --device.
#pragma once

#include <string>

#include "sim/simulation.hpp"

namespace thawslide::run {

// GPU that this program can use.
struct GpuFacts {
  std::string name;
  std::string unavailable_reason;  // reason why the GPU cannot be used; empty: it can
  double free = 0.0;               // memory before the run [bytes]
  double used = 0.0;               // by the run after its first steps [bytes]
  double seconds = 0.0;            // wall-clock time of the run, estimated from the first steps
};
[[nodiscard]] GpuFacts detect_gpu();

// Selects a GPU for the steps if requested: "gpu", or "auto" if there is one; "cpu" changes nothing. Returns the device
// as text; empty for the CPU. Throws UserError with the reason if the GPU is unavailable.
template <int Dim>
std::string use_device(const std::string& device, sim::Simulation<Dim>& simulation);

}  // namespace thawslide::run
