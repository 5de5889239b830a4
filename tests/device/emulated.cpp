#include "emulated.hpp"

#include "device/step_on.hpp"

namespace thawslide::device {

template <int Dim>
MakeStep<Dim, double> emulated(ThreadOrder order) {
  return [order](const auto& model, const auto& particles, std::size_t count, AskProcessor<Dim, double> ask) {
    return steps_on<Host>(model, particles, count, std::move(ask), order);
  };
}
template MakeStep<2, double> emulated<2>(ThreadOrder);
template MakeStep<3, double> emulated<3>(ThreadOrder);

}  // namespace thawslide::device
