// GPU detection and the solver on a GPU: gpu.cu, or without_gpu.cpp in a build without CUDA.
#pragma once

#include <string>

#include "device/solver_factory.hpp"

namespace thawslide::device {

// Launch mode of kernels. in_graphs: together, as a graph, when the CPU next waits for the GPU. one_by_one:
// immediately.
enum class Launching { in_graphs, one_by_one };

struct Gpu {
  bool is_usable = false;
  std::string name, unavailable_reason;
  double free = 0.0;  // free memory [bytes]
};
Gpu find_gpu();

// Solver on the GPU that find_gpu detected, in double precision. Errors are thrown as a Failure that states the failed
// operation.
template <int Dim>
SolverFactory<Dim> on_gpu(Launching launching = Launching::in_graphs);

}  // namespace thawslide::device
