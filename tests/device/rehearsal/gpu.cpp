// What src/device/gpu.cu says of a card, said of the processor in a card's place: `thawslide run --device gpu` then
// takes its steps by the code of the card, thread after thread.
#include "device/gpu.hpp"

#include "../emulated.hpp"

namespace thawslide::device {

template <int Dim>
SolverFactory<Dim, double> on_gpu(Launching /*launching*/) {
  return emulated<Dim>(ThreadOrder::shuffled);
}
template SolverFactory<2, double> on_gpu<2>(Launching);
template SolverFactory<3, double> on_gpu<3>(Launching);

Gpu find_gpu() { return {true, "the processor in a card's place", "", 8e9}; }

}  // namespace thawslide::device
