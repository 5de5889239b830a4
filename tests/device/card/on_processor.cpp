// The backend of the processor.
#include "device/host_backend.hpp"
#include "device/step_on.hpp"
#include "steps_on.hpp"

namespace thawslide::card_test {

template <int Dim>
device::MakeStep<Dim, Real> on_processor() {
  return [](const auto& model, const auto& particles, std::size_t count, device::AskProcessor<Dim, Real> ask) {
    return device::steps_on<device::Host>(model, particles, count, std::move(ask));
  };
}
template device::MakeStep<2, Real> on_processor<2>();
template device::MakeStep<3, Real> on_processor<3>();

}  // namespace thawslide::card_test
