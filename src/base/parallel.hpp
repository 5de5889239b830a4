// Parallel loops. The only place that names a parallel backend (OpenMP).
#pragma once

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

// Calls body(k) for k = 0 .. count-1, each once, on any thread. Calls may not depend on one another: results must not
// depend on which thread runs which k. The first exception thrown by a call is thrown again here.
template <class Body>
void parallel_for(std::size_t count, const Body& body) {
  std::exception_ptr failure;
#pragma omp parallel for schedule(dynamic, 4) if (count >= fewest_shared_calls)
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
