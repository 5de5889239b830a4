// CUDA solver factory and GPU detection.
#include "device/cuda_backend.hpp"
#include "device/gpu.hpp"
#include "device/solver_impl.hpp"

namespace thawslide::device {

template <int Dim>
SolverFactory<Dim> on_gpu(Launching launching) {
  return [launching](const StepModel<Dim>& model, const mpm::ParticleView<Dim>& particles, std::size_t count,
                     HostCallbacks<Dim> callbacks) {
    return steps_on<Cuda>(model, particles, count, std::move(callbacks), launching);
  };
}
template SolverFactory<2> on_gpu<2>(Launching);
template SolverFactory<3> on_gpu<3>(Launching);

Gpu find_gpu() {
  Gpu gpu;
  int count = 0;
  const cudaError_t found = cudaGetDeviceCount(&count);
  if (found == cudaErrorInsufficientDriver) {
    int driver = 0;
    static_cast<void>(cudaDriverGetVersion(&driver));
    gpu.unavailable_reason =
        driver == 0 ? "no NVIDIA driver found"
                    : "the NVIDIA driver is too old for CUDA " + std::to_string(CUDART_VERSION / 1000) + ": update it";
    return gpu;
  }
  if (found != cudaSuccess && found != cudaErrorNoDevice) {
    gpu.unavailable_reason = std::string("CUDA cannot be used: ") + cudaGetErrorString(found);
    return gpu;
  }
  if (count == 0) {
    gpu.unavailable_reason = "no NVIDIA GPU found";
    return gpu;
  }
  cudaDeviceProp known{};
  if (cudaGetDeviceProperties(&known, 0) != cudaSuccess) {
    gpu.unavailable_reason = "the NVIDIA GPU does not respond";
    return gpu;
  }
  gpu.name = std::string(known.name) + ", compute capability " + std::to_string(known.major) + "." +
             std::to_string(known.minor) + ", " + std::to_string(known.totalGlobalMem >> 30) + " GiB";
  try {
    const Cuda probe;
    std::size_t free = 0, total = 0;
    expect_done(cudaMemGetInfo(&free, &total), "reading the memory of the GPU");
    gpu.free = static_cast<double>(free);
  } catch (const GpuError& error) {
    const bool is_of_others =
        error.code() == cudaErrorNoKernelImageForDevice || error.code() == cudaErrorInvalidDeviceFunction;
    gpu.unavailable_reason = "the GPU (" + gpu.name + ") cannot run this program: " + error.what() +
                             (is_of_others ? ". Build with THAWSLIDE_CUDA_ARCHITECTURES for it" : "");
    return gpu;
  }
  gpu.is_usable = true;
  return gpu;
}

}  // namespace thawslide::device
