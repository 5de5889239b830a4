// CPU emulation of src/device/gpu.cu: `thawslide run --device gpu` executes the GPU code one thread at a time, in
// shuffled order.
#include "device/gpu.hpp"

#include "../emulated.hpp"

namespace thawslide::device {

template <int Dim>
SolverFactory<Dim> on_gpu(Launching /*launching*/) {
  return emulated<Dim>(ThreadOrder::shuffled);
}
template SolverFactory<2> on_gpu<2>(Launching);
template SolverFactory<3> on_gpu<3>(Launching);

Gpu find_gpu() { return {true, "CPU emulation", "", 8e9}; }

}  // namespace thawslide::device
