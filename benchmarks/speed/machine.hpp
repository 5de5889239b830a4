// What the machine can do at best: the roofline that docs/performance.md holds the step against.
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

// How often the core of this thread ticks now [GHz]: the faster of two chains of whole multiplications, of three ticks
// each as on x86-64, in half a millisecond. On a shared host it moves by a third within minutes, and with it every
// speed per second; what a core gives to another machine's thread it does not show.
[[nodiscard]] double clock_speed();

nlohmann::ordered_json to_json(const MachineLimits& limits);

}  // namespace thawslide::speed
