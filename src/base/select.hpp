// The words of formulas that serve one number, on processor and device, and the lanes of base/simd.hpp alike; here for
// one number. `select` stands in for a branch.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

#include "base/portability.hpp"

namespace thawslide {

// The type of a number, or of one lane.
template <class Value>
struct NumberOf {
  using Type = Value;
};

template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value select(bool condition, const Value& a, const Value& b) {
  return condition ? a : b;
}
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE bool any(bool condition) { return condition; }

// As of lanes: a where the two are equal or one is not a number. A device's own ones answer otherwise there.
template <class Real, class = std::enable_if_t<std::is_floating_point_v<Real>>>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Real min(Real a, Real b) {
  return b < a ? b : a;
}
template <class Real, class = std::enable_if_t<std::is_floating_point_v<Real>>>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Real max(Real a, Real b) {
  return a < b ? b : a;
}

// function(number), lane by lane.
template <class Real, class Function, class = std::enable_if_t<std::is_floating_point_v<Real>>>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Real map_lanes(Real number, const Function& function) {
  return function(number);
}

// Calls body(k) for the lanes k of a condition.
template <class Body>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void for_each_lane(bool condition, const Body& body) {
  if (condition) {
    body(std::size_t{0});
  }
}

// The number in one lane.
template <class Real, class = std::enable_if_t<std::is_floating_point_v<Real>>>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Real extract(Real number, std::size_t /*lane*/) {
  return number;
}
template <class Real, class = std::enable_if_t<std::is_floating_point_v<Real>>>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void set_lane(Real& number, std::size_t /*lane*/, Real other) {
  number = other;
}

// The number of a table at a place, a whole number.
template <class Real, class = std::enable_if_t<std::is_floating_point_v<Real>>>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Real look_up(const Real* table, const Real& place) {
  return table[static_cast<std::size_t>(place)];
}

// function(number), number by number and out of line: where that is the rare way.
template <class Value, class Function>
THAWSLIDE_HD [[gnu::noinline, gnu::cold]] Value cold_call(Value x, const Function& function) {
  return map_lanes(x, function);
}

// body(k) for k = 0 .. Count-1, k being a constant. An array of registers that is indexed by a variable leaves them.
template <std::size_t Count, class Body>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void unrolled(const Body& body) {
  [&]<std::size_t... K>(std::index_sequence<K...>) THAWSLIDE_INLINE_LAMBDA {
    (body(std::integral_constant<std::size_t, K>()), ...);
  }
  (std::make_index_sequence<Count>());
}

}  // namespace thawslide
