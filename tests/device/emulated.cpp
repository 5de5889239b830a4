#include "emulated.hpp"

#include "device/solver_impl.hpp"

namespace thawslide::device {

template <int Dim>
SolverFactory<Dim> emulated(ThreadOrder order, std::size_t threads) {
  return [order, threads](const auto& model, const auto& particles, std::size_t count, HostCallbacks<Dim> ask) {
    return steps_on<Host>(model, particles, count, std::move(ask), order, threads);
  };
}
template SolverFactory<2> emulated<2>(ThreadOrder, std::size_t);
template SolverFactory<3> emulated<3>(ThreadOrder, std::size_t);

}  // namespace thawslide::device
