// Parallel loops. The only place that names a parallel backend (OpenMP).
#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>

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

// Calls a thread takes at a time: few enough for threads to end together, enough for the handing out not to count.
inline std::size_t calls_at_a_time(std::size_t count) {
  constexpr std::size_t most = 16, shares = 8;  // of a thread
  return std::clamp<std::size_t>(count / (shares * static_cast<std::size_t>(thread_count())), 1, most);
}

// Calls body(k) for k = 0 .. count-1, each once, on any thread. Calls may not depend on one another: results must not
// depend on which thread runs which k. The first exception thrown by a call is thrown again here.
template <class Body>
void parallel_for(std::size_t count, const Body& body) {
  std::exception_ptr failure;
  const std::size_t calls = calls_at_a_time(count);
#pragma omp parallel for schedule(dynamic, calls) if (count >= fewest_shared_calls)
  for (std::size_t k = 0; k < count; ++k) {
    try {
      body(k);
    } catch (...) {
#pragma omp critical(thawslide_parallel_failure)
      if (!failure) {
        failure = std::current_exception();
      }
    }
  }
  if (failure) {
    std::rethrow_exception(failure);
  }
}

}  // namespace thawslide
