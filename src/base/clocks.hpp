// Clocks [s], for differences only, and wall-clock time per named stage.
#pragma once

#include <chrono>
#include <ctime>
#include <map>
#include <string>
#include <string_view>

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

class Stopwatch {
 public:
  // by stage; transparent comparison avoids copies of the name
  using Seconds = std::map<std::string, double, std::less<>>;

  // Runs a stage and adds its wall-clock time [s] to the stage's total.
  template <class Stage>
  void time(std::string_view stage, const Stage& run) {
    const double start = wall_clock();
    run();
    auto entry = seconds_.find(stage);
    if (entry == seconds_.end()) {
      entry = seconds_.emplace(stage, 0.0).first;
    }
    entry->second += wall_clock() - start;
  }

  [[nodiscard]] const Seconds& seconds() const { return seconds_; }

 private:
  Seconds seconds_;
};

}  // namespace thawslide
