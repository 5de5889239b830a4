// Factory of solvers on a device. The types of their interface are declared only, such that files that include this one
// do not compile them.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace thawslide::mpm {
template <int Dim>
struct ParticleView;
}  // namespace thawslide::mpm

namespace thawslide::device {

template <int Dim>
class Solver;
template <int Dim>
struct StepModel;
template <int Dim>
struct StepSums;
template <int Dim>
struct HostCallbacks;

// Copies `count` particles to a device and creates the solver there.
template <int Dim>
using SolverFactory = std::function<std::unique_ptr<Solver<Dim>>(const StepModel<Dim>&, const mpm::ParticleView<Dim>&,
                                                                 std::size_t count, HostCallbacks<Dim>)>;

}  // namespace thawslide::device
