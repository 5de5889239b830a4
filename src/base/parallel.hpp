// Parallel loops, and a permutation of items by them. Only parallel.cpp depends on the backend.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "base/aligned.hpp"
#include "base/error.hpp"
#include "base/sums.hpp"

namespace thawslide {

// Number of threads used by the loops below; at least 1.
[[nodiscard]] int thread_count();
void set_thread_count(int threads);

// Ends the waiting threads, before a fork: the new process has no copies of them and would wait for them for ever.
void end_waiting_threads();

// Number of cores available to this process.
[[nodiscard]] int available_cores();

// Sets the number of threads; 0: all available cores.
inline void use_threads(int threads) { set_thread_count(threads > 0 ? threads : available_cores()); }

// The same during its lifetime. One thread: for many loops too short to run in parallel.
class ThreadScope {
 public:
  explicit ThreadScope(int threads) : before_(thread_count()) { use_threads(threads); }
  ~ThreadScope() { set_thread_count(before_); }
  ThreadScope(const ThreadScope&) = delete;
  ThreadScope& operator=(const ThreadScope&) = delete;

 private:
  int before_;
};

// Loops with fewer calls than this run on the calling thread, because waking others would cost more.
inline constexpr std::size_t fewest_shared_calls = 9;

// Makes waiting threads spin for microseconds and then sleep, unless OMP_WAIT_POLICY is set. Restarts the program, as
// OpenMP reads this setting before main begins.
void set_passive_wait(char** arguments);

// Calls per chunk: few enough for an even load, enough to make the overhead negligible.
[[nodiscard]] std::size_t calls_at_a_time(std::size_t count);

// Calls run(body, first, last) for chunks of the calls. Each thread begins with the same part in all loops, for caches.
void parallel_chunks(std::size_t count, std::size_t at_a_time,
                     void (*run)(const void* body, std::size_t first, std::size_t last), const void* body);

// Calls body(k) for k = 0 .. count-1, each once, on any thread. They must be independent. Rethrows the first exception.
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

// Sum over body(k, sum), each starting from zero, added in runs (base/sums.hpp): bitwise independent of the threads.
template <class Sum, class Body>
[[nodiscard]] Sum parallel_sum(std::size_t count, const Body& body) {
  thread_local std::vector<Sum> buffer;  // persistent, to avoid allocation in each step
  THAWSLIDE_ASSERT(buffer.empty(), "a sum of {} calls within one of {}", count, buffer.size());
  buffer.resize(count);
  Sum* sums = buffer.data();
  try {
    parallel_for(count, [&](std::size_t k) {
      Sum sum{};
      body(k, sum);
      sums[k] = sum;
    });
  } catch (...) {
    buffer.clear();
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
  buffer.clear();
  return sum;
}

// One entry per item, of up to eight bytes.
using ReorderBuffer = std::vector<std::uint64_t>;

// Moves the item at order[k] to k. order: a permutation. get(k) and set(k, item) access the items.
template <class Item, class Get, class Set>
void reorder(const std::vector<std::uint32_t>& order, ReorderBuffer& buffer, const Get& get, const Set& set) {
  static_assert(sizeof(Item) <= sizeof(ReorderBuffer::value_type));
  constexpr std::size_t at_a_time = 4096;
  resize_sparingly(buffer, order.size());
  parallel_for(order.size(), at_a_time, [&](std::size_t k) {
    const Item item = get(static_cast<std::size_t>(order[k]));
    std::memcpy(&buffer[k], &item, sizeof item);
  });
  parallel_for(order.size(), at_a_time, [&](std::size_t k) {
    Item item;
    std::memcpy(&item, &buffer[k], sizeof item);
    set(k, item);
  });
}

}  // namespace thawslide
