// Build without CUDA (THAWSLIDE_CUDA=OFF): no GPU is usable.
#include "base/error.hpp"
#include "device/gpu.hpp"

namespace thawslide::device {

Gpu find_gpu() {
  return {false, "", "this program was built without CUDA; to build with CUDA 12 or later: ./run --setup --gpu", 0.0};
}

template <int Dim>
SolverFactory<Dim> on_gpu(Launching /*launching*/) {
  throw UserError(find_gpu().unavailable_reason);
}
template SolverFactory<2> on_gpu<2>(Launching);
template SolverFactory<3> on_gpu<3>(Launching);

}  // namespace thawslide::device
