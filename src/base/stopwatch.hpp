// Wall-clock time per named stage.
#pragma once

#include <chrono>
#include <map>
#include <string>

namespace thawslide {

class Stopwatch {
 public:
  // Runs a stage and adds its wall time [s] to the stage's account.
  template <class Stage>
  void time(const char* stage, const Stage& run) {
    const auto start = std::chrono::steady_clock::now();
    run();
    seconds_[stage] += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  [[nodiscard]] const std::map<std::string, double>& seconds() const { return seconds_; }

 private:
  std::map<std::string, double> seconds_;
};

}  // namespace thawslide
