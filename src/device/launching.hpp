// Launch mode of GPU kernels.
#pragma once

namespace thawslide::device {

// in_graphs: together, as a graph, when the CPU next waits for the GPU. one_by_one: immediately.
enum class Launching { in_graphs, one_by_one };

}  // namespace thawslide::device
