// Function attributes, small constants and prefetching for all modules.
#pragma once

#include <cstddef>
#include <cstdint>

// Function callable from host and device code.
#if defined(__CUDACC__) || defined(__HIPCC__)
#define THAWSLIDE_HD __host__ __device__
#else
#define THAWSLIDE_HD
#endif

// Prevents a device compiler from unrolling a loop, which would move its arrays from memory to registers.
#if defined(__CUDA_ARCH__)
#define THAWSLIDE_ROLLED _Pragma("unroll 1")
#else
#define THAWSLIDE_ROLLED
#endif

// Forces inlining in the innermost loops, where g++ would pass results through memory. The second follows a lambda's
// parameters. Builds with checks override them.
#ifndef THAWSLIDE_ALWAYS_INLINE
#define THAWSLIDE_ALWAYS_INLINE [[gnu::always_inline]] inline
#endif
#ifndef THAWSLIDE_INLINE_LAMBDA
#define THAWSLIDE_INLINE_LAMBDA __attribute__((always_inline))
#endif

namespace thawslide {

// Prefetches the memory a number of bytes ahead. The address need not be valid, hence an integer instead of a pointer.
inline void prefetch(const void* point, std::size_t bytes_on) {
  const auto there = reinterpret_cast<std::uintptr_t>(point) + bytes_on;
  __builtin_prefetch(reinterpret_cast<const void*>(there));  // NOLINT(performance-no-int-to-ptr)
}

// Relative tolerance: smaller differences count as round-off.
inline constexpr double round_off = 1e-9;

// Absolute temperature of 0 degrees Celsius [K].
inline constexpr double celsius_to_kelvin = 273.15;

inline constexpr double pi = 3.14159265358979323846;

}  // namespace thawslide
