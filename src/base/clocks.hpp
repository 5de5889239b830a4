// Clocks [s], for differences only.
#pragma once

#include <chrono>
#include <ctime>

namespace thawslide {

// Processor time of the calling thread: independent of the load of the machine, except through shared caches.
inline double thread_clock() {
  timespec spent{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &spent);
  return static_cast<double>(spent.tv_sec) + 1e-9 * static_cast<double>(spent.tv_nsec);
}

inline double wall_clock() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace thawslide
