// Parallel loops. Their backend is named in parallel.cpp alone.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <vector>

#include "base/error.hpp"
#include "base/sum_order.hpp"

namespace thawslide {

// Threads the loops below run on; at least 1.
[[nodiscard]] int thread_count();
void set_thread_count(int threads);

// While one lives, the loops below run on the thread that made it alone: for many that are too short to share out.
class SingleThreadScope {
 public:
  SingleThreadScope() : threads_(thread_count()) { set_thread_count(1); }
  ~SingleThreadScope() { set_thread_count(threads_); }
  SingleThreadScope(const SingleThreadScope&) = delete;
  SingleThreadScope& operator=(const SingleThreadScope&) = delete;

 private:
  int threads_;
};

// Cores this process may run on.
[[nodiscard]] int available_cores();

// Fewer calls than this are not worth waking other threads for.
inline constexpr std::size_t fewest_shared_calls = 9;

// Makes threads that wait spin for some microseconds, which spares most waits within a step a trip through the kernel,
// and then sleep, so that they do not burn a core another process needs. The OpenMP library reads this before main
// begins: unless the user has chosen otherwise the program starts itself once more with it set.
void set_passive_wait(char** arguments);

// Calls a thread takes at a time: few enough for threads to end together, enough for the handing out not to count.
[[nodiscard]] std::size_t calls_at_a_time(std::size_t count);

// Calls run(body, first, last) until the calls 0 .. count-1 have been run, so many at a time. Every thread begins with
// a share of its own, the same in every loop, so that it finds in its caches what it left there, and then takes from
// the others'.
void parallel_chunks(std::size_t count, std::size_t at_a_time,
                     void (*run)(const void* body, std::size_t first, std::size_t last), const void* body);

// Calls body(k) for k = 0 .. count-1, each once, on any thread. Calls may not depend on one another: results must not
// depend on which thread runs which k. The first exception thrown by a call is thrown again here; calls that had not
// begun by then may be left out.
template <class Body>
void parallel_for(std::size_t count, std::size_t at_a_time, const Body& body) {
  const auto run = [](const void* calls, std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      (*static_cast<const Body*>(calls))(k);
    }
  };
  parallel_chunks(count, at_a_time, run, &body);
}
template <class Body>
void parallel_for(std::size_t count, const Body& body) {
  parallel_for(count, calls_at_a_time(count), body);
}

// Returns whether body(k) is true for any k = 0 .. count-1. Calls may be skipped after the first true result.
template <class Body>
[[nodiscard]] bool parallel_any(std::size_t count, const Body& body) {
  std::atomic<bool> found{false};
  parallel_for(count, [&](std::size_t k) {
    if (!found.load(std::memory_order_relaxed) && body(k)) {
      found.store(true, std::memory_order_relaxed);
    }
  });
  return found.load();
}

// What body(k, sum) adds up for k = 0 .. count-1, each once and from zero, on any thread; then call after call, in runs
// (base/sum_order.hpp). No bit of the sum depends on how many calls run at a time.
template <class Sum, class Body>
[[nodiscard]] Sum parallel_sum(std::size_t count, const Body& body) {
  thread_local std::vector<Sum> room;  // kept: a step allocates nothing
  THAWSLIDE_ASSERT(room.empty(), "a sum of {} calls within one of {}", count, room.size());
  room.resize(count);
  Sum* sums = room.data();
  try {
    parallel_for(count, [&](std::size_t k) {
      Sum sum{};
      body(k, sum);
      sums[k] = sum;
    });
  } catch (...) {
    room.clear();
    throw;
  }
  Sum sum{};
  for (std::size_t first = 0; first < count; first += parts_of_a_run) {
    const std::size_t last = std::min(first + parts_of_a_run, count);
    Sum run{};
    for (std::size_t k = first; k < last; ++k) {
      run += sums[k];
    }
    sum += run;
  }
  room.clear();
  return sum;
}

}  // namespace thawslide
