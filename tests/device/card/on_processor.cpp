// The backend of the processor.
#include "device/host_backend.hpp"
#include "steps_on.hpp"

namespace thawslide::card_test {

template <int Dim>
std::unique_ptr<Steps<Dim>> on_processor(const ParticleMemory<Dim>& particles) {
  return std::make_unique<StepsOn<device::Host, Dim>>(particles);
}
template std::unique_ptr<Steps<2>> on_processor<2>(const ParticleMemory<2>&);
template std::unique_ptr<Steps<3>> on_processor<3>(const ParticleMemory<3>&);

}  // namespace thawslide::card_test
