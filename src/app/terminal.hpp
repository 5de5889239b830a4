// Run on a terminal or in a log: lines, progress as a bar on a terminal and as plain lines otherwise, and signals.
#pragma once

#include <chrono>
#include <string>

#include "run/observer.hpp"

namespace thawslide::app {

class Terminal final : public run::Observer {
 public:
  Terminal();

  // From the first call on, signals interrupt the run (app/signals.hpp).
  void start(double time) override;
  void text(const std::string& line) override;
  void error(const std::string& line) override;
  [[nodiscard]] bool wants_progress(double time, double end) override;
  void progress(const run::ProgressState& state) override;
  void end_progress() override;
  [[nodiscard]] std::string interruption() override;

 private:
  using Clock = std::chrono::steady_clock;

  bool is_terminal_;
  bool is_drawn_ = false;
  double begin_ = 0.0, last_fraction_ = 0.0;
  double work_ = 0.0;   // time to show the last state, including the caller's part [s]
  double begun_ = 0.0;  // start of that work, in CPU time [s]
  Clock::time_point start_, last_;
};

}  // namespace thawslide::app
