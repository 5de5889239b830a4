// Limits of the machine: the roofline with which benchmarks/README.md compares the step.
#pragma once

#include <nlohmann/json.hpp>

namespace thawslide::speed {

struct MachineLimits {
  double clock;          // when the others were measured [GHz]
  double multiply_add;   // fused multiply-adds counted as two, one core [GFLOP/s]
  double triad_cache;    // a[k] = b[k] + s c[k] over 96 KiB, one core [GB/s]
  double triad_memory;   // the same over 192 MiB, one core [GB/s]
  double triad_threads;  // the same on all cores [GB/s]
};

MachineLimits measure_machine(int threads);

// Present clock rate [GHz] of the core of this thread: the faster of two chains of integer multiplications, of three
// ticks each as on x86-64, in half a millisecond. On a shared host it varies by a third within minutes, and every speed
// per second with it. It does not include the time that a core spends on threads of other virtual machines.
[[nodiscard]] double clock_speed();

nlohmann::ordered_json to_json(const MachineLimits& limits);

}  // namespace thawslide::speed
