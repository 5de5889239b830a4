#include "emulated.hpp"

#include "device/solver_impl.hpp"

namespace thawslide::device {

template <int Dim>
SolverFactory<Dim> emulated(ThreadOrder order) {
  return [order](const auto& model, const auto& particles, std::size_t count, HostCallbacks<Dim> ask) {
    return steps_on<Host>(model, particles, count, std::move(ask), order);
  };
}
template SolverFactory<2> emulated<2>(ThreadOrder);
template SolverFactory<3> emulated<3>(ThreadOrder);

}  // namespace thawslide::device
