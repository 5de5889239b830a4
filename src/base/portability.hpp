// Marks, small constants and the hint of a prefetch every room shares.
#pragma once

#include <cstddef>
#include <cstdint>

// A function with this mark may be called from host and from device code.
#if defined(__CUDACC__) || defined(__HIPCC__)
#define THAWSLIDE_HD __host__ __device__
#else
#define THAWSLIDE_HD
#endif

// Before a loop that a device's compiler shall not unroll: what lies in memory there would come to need registers.
#if defined(__CUDA_ARCH__)
#define THAWSLIDE_ROLLED _Pragma("unroll 1")
#else
#define THAWSLIDE_ROLLED
#endif

// A small function of the innermost loops that g++ leaves out of line on its own, at the price of passing its result
// through memory; the second one stands after a lambda's parameters. Builds that check and need no speed say otherwise.
#ifndef THAWSLIDE_ALWAYS_INLINE
#define THAWSLIDE_ALWAYS_INLINE [[gnu::always_inline]] inline
#endif
#ifndef THAWSLIDE_INLINE_LAMBDA
#define THAWSLIDE_INLINE_LAMBDA __attribute__((always_inline))
#endif

namespace thawslide {

// Asks the memory for what lies so many bytes on, which need not be there at all: a number, not a pointer, goes there.
inline void prefetch(const void* place, std::size_t bytes_on) {
  const auto there = reinterpret_cast<std::uintptr_t>(place) + bytes_on;
  __builtin_prefetch(reinterpret_cast<const void*>(there));  // NOLINT(performance-no-int-to-ptr)
}

// A tolerance in either precision.
template <class Real>
THAWSLIDE_HD constexpr Real by_precision(double in_double, double in_single) {
  return static_cast<Real>(sizeof(Real) == sizeof(double) ? in_double : in_single);
}

// Relative differences below are taken for round-off.
template <class Real>
inline constexpr Real round_off = by_precision<Real>(1e-9, 1e-5);

// Absolute temperature of 0 degrees Celsius [K].
template <class Real>
inline constexpr Real celsius_to_kelvin = static_cast<Real>(273.15);

template <class Real>
inline constexpr Real pi = static_cast<Real>(3.14159265358979323846);

}  // namespace thawslide
