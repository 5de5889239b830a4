// Reductions over all particles, one per line. sim::Solver computes them on the CPU and on a device. A reduction has
//   Sums                      its result, a type that no other reduction has, with += and zero by default
//   operator()(particles, p)  the contribution of particle p, for host and device
#pragma once

#include <variant>

#include "band/body_sums.hpp"
#include "mpm/mass_moments.hpp"
#include "mpm/monitor_sums.hpp"

namespace thawslide::device {

template <int Dim>
using AnyReduction = std::variant<  //
    mpm::MonitorKernel<Dim>,        //
    mpm::MomentsOfParticle,         //
    band::SumsOfParticle<Dim>>;

namespace detail {

template <class Reductions>
struct SumsOfAll;
template <class... Reductions>
struct SumsOfAll<std::variant<Reductions...>> {
  using Type = std::variant<typename Reductions::Sums...>;
};

}  // namespace detail

// Result of a reduction.
template <int Dim>
using AnySums = typename detail::SumsOfAll<AnyReduction<Dim>>::Type;

}  // namespace thawslide::device
