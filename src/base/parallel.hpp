// Parallel loops. The only place that names a parallel backend (OpenMP).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace thawslide {

// Threads the loops below run on; at least 1.
[[nodiscard]] int thread_count();
void set_thread_count(int threads);

// Cores this process may run on.
[[nodiscard]] int available_cores();

// Fewer calls than this are not worth waking other threads for.
inline constexpr std::size_t fewest_shared_calls = 9;

// Makes threads that wait spin for some microseconds, which spares most waits within a step a trip through the kernel,
// and then sleep, so that they do not burn a core another process needs. The OpenMP library reads this before main
// begins: unless the user has chosen otherwise the program starts itself once more with it set.
void let_threads_wait_passively(char** arguments);

// Calls run(body, first, last) until the calls 0 .. count-1 have been run, each once. Every thread begins with a share
// of its own, the same in every loop, so that it finds in its caches what it left there, and then takes from the
// others'.
void share_out(std::size_t count, void (*run)(const void* body, std::size_t first, std::size_t last), const void* body);

// Calls body(k) for k = 0 .. count-1, each once, on any thread. Calls may not depend on one another: results must not
// depend on which thread runs which k. The first exception thrown by a call is thrown again here.
template <class Body>
void parallel_for(std::size_t count, const Body& body) {
  const auto run = [](const void* calls, std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      (*static_cast<const Body*>(calls))(k);
    }
  };
  share_out(count, run, &body);
}

// What body(k, sum) adds up for k = 0 .. count-1, each once, on any thread: within shares of the calls in order, then
// share after share. The shares follow from `count` alone, and so does every bit of the sum.
template <class Sum, class Body>
[[nodiscard]] Sum parallel_sum(std::size_t count, const Body& body) {
  constexpr std::size_t most_shares = 256;
  const std::size_t calls = std::max<std::size_t>(1, (count + most_shares - 1) / most_shares);  // of a share
  std::array<Sum, most_shares> parts;
  const std::size_t shares = (count + calls - 1) / calls;
  parallel_for(shares, [&](std::size_t share) {
    Sum part{};
    for (std::size_t k = share * calls; k < std::min(count, (share + 1) * calls); ++k) {
      body(k, part);
    }
    parts[share] = part;
  });
  Sum sum{};
  for (std::size_t share = 0; share < shares; ++share) {
    sum += parts[share];
  }
  return sum;
}

}  // namespace thawslide
