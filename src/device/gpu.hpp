// Whether there is a card, which, and steps on it. Built where nvcc is found; THAWSLIDE_WITH_GPU is defined then.
#pragma once

#include <string>

#include "device/launching.hpp"
#include "device/solver.hpp"

namespace thawslide::device {

struct Gpu {
  bool is_usable = false;
  std::string name, why_not;
  double free = 0.0;  // memory [bytes]
};
Gpu find_gpu();

// Steps on the card that find_gpu found, in double precision. What goes wrong on the way
// is thrown as a Failure that says what the card was doing.
template <int Dim>
SolverFactory<Dim, double> on_gpu(Launching launching = Launching::in_graphs);

}  // namespace thawslide::device
