#include "base/parallel.hpp"

#include <omp.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <exception>

namespace thawslide {

namespace {

constexpr std::size_t most_chunks = 64;

// Pending calls next .. last-1 of one thread.
struct alignas(cache_line) Chunk {
  std::atomic<std::size_t> next;
  std::size_t last;
};

}  // namespace

int thread_count() { return omp_get_max_threads(); }

void set_thread_count(int threads) {
  THAWSLIDE_ASSERT(threads >= 1, "{} threads", threads);
  omp_set_num_threads(threads);
}

void end_waiting_threads() { omp_pause_resource_all(omp_pause_soft); }

int available_cores() { return omp_get_num_procs(); }

std::size_t calls_at_a_time(std::size_t count) {
  constexpr std::size_t most = 16, parts = 8;  // most: calls per chunk; parts: fewest chunks per thread
  return std::clamp<std::size_t>(count / (parts * static_cast<std::size_t>(thread_count())), 1, most);
}

void parallel_chunks(std::size_t count, std::size_t at_a_time,
                     void (*run)(const void* body, std::size_t first, std::size_t last), const void* body) {
  const auto threads = static_cast<std::size_t>(thread_count());
  if (threads == 1 || count < fewest_shared_calls) {
    run(body, 0, count);
    return;
  }
  const std::size_t chunks = std::min(threads, most_chunks);
  std::array<Chunk, most_chunks> of_thread;
  for (std::size_t s = 0; s < chunks; ++s) {
    of_thread[s].next.store(s * count / chunks, std::memory_order_relaxed);
    of_thread[s].last = (s + 1) * count / chunks;
  }
  std::exception_ptr failure;
#pragma omp parallel
  try {
    for (std::size_t s = 0; s < chunks; ++s) {
      Chunk& chunk = of_thread[(static_cast<std::size_t>(omp_get_thread_num()) + s) % chunks];
      while (chunk.next.load(std::memory_order_relaxed) < chunk.last) {
        const std::size_t first = chunk.next.fetch_add(at_a_time, std::memory_order_relaxed);
        if (first < chunk.last) {
          run(body, first, std::min(first + at_a_time, chunk.last));
        }
      }
    }
  } catch (...) {
#pragma omp critical(thawslide_parallel_failure)
    if (!failure) {
      failure = std::current_exception();
    }
  }
  if (failure) {
    std::rethrow_exception(failure);
  }
}

void set_passive_wait(char** arguments) {
  if (std::getenv("OMP_WAIT_POLICY") == nullptr) {
    setenv("OMP_WAIT_POLICY", "passive", 1);
    setenv("GOMP_SPINCOUNT", "1000", 0);
    execv("/proc/self/exe", arguments);
  }
}

}  // namespace thawslide
