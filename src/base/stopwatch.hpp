// Wall-clock time per named stage.
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <string_view>

namespace thawslide {

class Stopwatch {
 public:
  // by stage; transparent comparison avoids copies of the name
  using Seconds = std::map<std::string, double, std::less<>>;

  // Runs a stage and adds its wall-clock time [s] to the stage's total.
  template <class Stage>
  void time(std::string_view stage, const Stage& run) {
    const auto start = std::chrono::steady_clock::now();
    run();
    auto entry = seconds_.find(stage);
    if (entry == seconds_.end()) {
      entry = seconds_.emplace(stage, 0.0).first;
    }
    entry->second += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  [[nodiscard]] const Seconds& seconds() const { return seconds_; }

 private:
  Seconds seconds_;
};

}  // namespace thawslide
