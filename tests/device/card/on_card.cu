// The backend of a card, and what is known of the card.
#include "card.hpp"
#include "device/cuda_backend.hpp"
#include "steps_on.hpp"

namespace thawslide::card_test {

template <int Dim>
std::unique_ptr<Steps<Dim>> on_card(const ParticleMemory<Dim>& particles) {
  return std::make_unique<StepsOn<device::Cuda, Dim>>(particles);
}
template std::unique_ptr<Steps<2>> on_card<2>(const ParticleMemory<2>&);
template std::unique_ptr<Steps<3>> on_card<3>(const ParticleMemory<3>&);

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
  if (found != cudaSuccess || count == 0) {
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
    const device::Cuda probe;
  } catch (const device::CardError& error) {
    card.why_not = "the card (" + card.name + ") cannot run this program: " + error.what() +
                   ". Build with THAWSLIDE_CUDA_ARCHITECTURES for it";
    return card;
  }
  card.is_usable = true;
  return card;
}

}  // namespace thawslide::card_test
