// The backend of the processor.
#include "device/step_on.hpp"
#include "steps_on.hpp"

namespace thawslide::card_test {

template <int Dim>
device::MakeStep<Dim, Real> on_processor(device::ThreadOrder order) {
  return [order](const auto& model, const auto& particles, std::size_t count, device::AskProcessor<Dim, Real> ask) {
    return device::steps_on<device::Host>(model, particles, count, std::move(ask), order);
  };
}
template device::MakeStep<2, Real> on_processor<2>(device::ThreadOrder);
template device::MakeStep<3, Real> on_processor<3>(device::ThreadOrder);

}  // namespace thawslide::card_test
