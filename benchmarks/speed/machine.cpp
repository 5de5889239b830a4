#include "machine.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>

#include "base/aligned.hpp"
#include "base/parallel.hpp"
#include "base/simd.hpp"

namespace thawslide::speed {

namespace {

constexpr double giga = 1e9;

template <class Work>
double best_of(int times, const Work& work) {
  double best = 1e300;
  for (int k = 0; k < times; ++k) {
    const auto start = std::chrono::steady_clock::now();
    work();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

// [GB/s] of three arrays of `length` doubles, read and written `repeats` times.
double triad(std::size_t length, int repeats, std::size_t parts) {
  AlignedVector<double> a(length, 1.0), b(length, 2.0), c(length, 3.0);
  const double seconds = best_of(5, [&] {
    parallel_for(parts, [&](std::size_t part) {
      const std::size_t first = length * part / parts;
      const std::size_t last = length * (part + 1) / parts;
      for (int r = 0; r < repeats; ++r) {
        for (std::size_t k = first; k < last; ++k) {
          a[k] = b[k] + 0.5 * c[k];
        }
        benchmark::ClobberMemory();
      }
    });
  });
  return 3.0 * sizeof(double) * static_cast<double>(length) * repeats / seconds / giga;
}

// Enough independent chains of multiply-adds to fill the pipelines, few enough to stay in registers.
double multiply_add() {
  using Numbers = Simd<double>;
  constexpr std::size_t chains = 12;
  constexpr int rounds = 2'000'000;
  double start = 1.0, factor = 0.999999;
  benchmark::DoNotOptimize(start);
  benchmark::DoNotOptimize(factor);
  double sink = 0.0;
  const double seconds = best_of(5, [&] {
    std::array<Numbers, chains> x;
    // Start values differ, because g++ would merge equal chains.
    unrolled<chains>([&](auto k) THAWSLIDE_INLINE_LAMBDA { x[k] = Numbers(start + static_cast<double>(k())); });
    for (int r = 0; r < rounds; ++r) {
      unrolled<chains>([&](auto k) THAWSLIDE_INLINE_LAMBDA { x[k] = x[k] * Numbers(factor) + Numbers(1e-6); });
    }
    unrolled<chains>([&](auto k) THAWSLIDE_INLINE_LAMBDA { sink += x[k][0]; });
    benchmark::DoNotOptimize(sink);
  });
  return 2.0 * static_cast<double>(chains * Numbers::count) * rounds / seconds / giga;
}

}  // namespace

MachineLimits measure_machine(int threads) {
  constexpr std::size_t in_cache = 4'096;
  constexpr std::size_t in_memory = 8'388'608;
  MachineLimits limits{};
  limits.clock = clock_speed();
  limits.multiply_add = multiply_add();
  set_thread_count(1);
  limits.triad_cache = triad(in_cache, 20'000, 1);
  limits.triad_memory = triad(in_memory, 3, 1);
  set_thread_count(threads);
  limits.triad_threads = triad(in_memory, 3, std::max<std::size_t>(fewest_shared_calls, 16));
  return limits;
}

double clock_speed() {
  constexpr int multiplications = 200'000, ticks = 3;
  std::uint64_t product = 3;
  const double seconds = best_of(2, [&] {
    for (int k = 0; k < multiplications; ++k) {
      product *= product;
      asm volatile("" : "+r"(product));  // stays in its register, unknown to the compiler
    }
  });
  return multiplications * ticks / seconds / giga;
}

nlohmann::ordered_json to_json(const MachineLimits& limits) {
  return {{"clock_GHz", limits.clock},
          {"multiply_add_GFLOP_s", limits.multiply_add},
          {"triad_cache_GB_s", limits.triad_cache},
          {"triad_memory_GB_s", limits.triad_memory},
          {"triad_memory_all_threads_GB_s", limits.triad_threads}};
}

}  // namespace thawslide::speed
