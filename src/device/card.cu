// The backend of a card, and what is known of the card.
#include "device/card.hpp"
#include "device/cuda_backend.hpp"
#include "device/step_on.hpp"

namespace thawslide::device {

template <int Dim>
MakeStep<Dim, double> on_card(Launching launching) {
  return [launching](const StepModel<Dim, double>& model, const mpm::ParticleView<Dim, double>& particles,
                     std::size_t count, AskProcessor<Dim, double> ask) {
    return steps_on<Cuda>(model, particles, count, std::move(ask), launching);
  };
}
template MakeStep<2, double> on_card<2>(Launching);
template MakeStep<3, double> on_card<3>(Launching);

Card find_card() {
  Card card;
  int count = 0;
  const cudaError_t found = cudaGetDeviceCount(&count);
  if (found == cudaErrorInsufficientDriver) {
    int driver = 0;
    static_cast<void>(cudaDriverGetVersion(&driver));
    card.why_not =
        driver == 0 ? "there is no NVIDIA driver"
                    : "the NVIDIA driver is too old for CUDA " + std::to_string(CUDART_VERSION / 1000) + ": update it";
    return card;
  }
  if (found != cudaSuccess && found != cudaErrorNoDevice) {
    card.why_not = std::string("CUDA cannot be used: ") + cudaGetErrorString(found);
    return card;
  }
  if (count == 0) {
    card.why_not = "there is no NVIDIA card";
    return card;
  }
  cudaDeviceProp known{};
  if (cudaGetDeviceProperties(&known, 0) != cudaSuccess) {
    card.why_not = "the NVIDIA card does not answer";
    return card;
  }
  card.name = std::string(known.name) + ", compute capability " + std::to_string(known.major) + "." +
              std::to_string(known.minor) + ", " + std::to_string(known.totalGlobalMem >> 30) + " GiB";
  try {
    const Cuda probe;
    std::size_t free = 0, total = 0;
    expect_done(cudaMemGetInfo(&free, &total), "asking the card for its memory");
    card.free = static_cast<double>(free);
  } catch (const CardError& error) {
    const bool is_of_others =
        error.code() == cudaErrorNoKernelImageForDevice || error.code() == cudaErrorInvalidDeviceFunction;
    card.why_not = "the card (" + card.name + ") cannot run this program: " + error.what() +
                   (is_of_others ? ". Build with THAWSLIDE_CUDA_ARCHITECTURES for it" : "");
    return card;
  }
  card.is_usable = true;
  return card;
}

}  // namespace thawslide::device
