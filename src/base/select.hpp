// Functions of formulas that work on one number, on CPU and device, and on SIMD lanes (base/simd.hpp); here for one.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

#include "base/portability.hpp"

namespace thawslide {

template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value select(bool condition, const Value& a, const Value& b) {
  return condition ? a : b;
}
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE bool any(bool condition) { return condition; }

// As for lanes: a if both are equal or one is NaN. The device's built-in functions differ in this.
template <class T, class = std::enable_if_t<std::is_floating_point_v<T>>>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE T min(T a, T b) {
  return b < a ? b : a;
}
template <class T, class = std::enable_if_t<std::is_floating_point_v<T>>>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE T max(T a, T b) {
  return a < b ? b : a;
}

// function(number), by lane.
template <class T, class Function, class = std::enable_if_t<std::is_floating_point_v<T>>>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE T map_lanes(T number, const Function& function) {
  return function(number);
}

// Calls body(k) for the lanes k of a condition.
template <class Body>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void for_each_lane(bool condition, const Body& body) {
  if (condition) {
    body(std::size_t{0});
  }
}

// Number in one lane.
template <class T, class = std::enable_if_t<std::is_floating_point_v<T>>>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE T extract(T number, std::size_t /*lane*/) {
  return number;
}

// Table entry at an integer place.
template <class T, class = std::enable_if_t<std::is_floating_point_v<T>>>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE T look_up(const T* table, const T& index) {
  return table[static_cast<std::size_t>(index)];
}

// function(number), by lane and out of line: for rare cases.
template <class Value, class Function>
THAWSLIDE_HD [[gnu::noinline, gnu::cold]] Value cold_call(Value x, const Function& function) {
  return map_lanes(x, function);
}

// Calls body(k) with constant k: indexing an array of registers by a variable would move it to memory.
template <std::size_t Count, class Body>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void unrolled(const Body& body) {
  [&]<std::size_t... K>(std::index_sequence<K...>) THAWSLIDE_INLINE_LAMBDA {
    (body(std::integral_constant<std::size_t, K>()), ...);
  }
  (std::make_index_sequence<Count>());
}

}  // namespace thawslide
