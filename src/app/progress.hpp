// Progress of a run: a bar on a terminal, otherwise plain lines.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace thawslide::app {

// Contents of a progress line.
struct ProgressState {
  double time, end;  // simulated [s]
  std::int64_t steps;
  double front_position, front_speed;  // [m], [m/s]; NaN while unknown
};

class Progress {
 public:
  // `begin`: simulated start time of the run [s].
  explicit Progress(double begin);

  // True if enough wall-clock time has passed for a new line. The caller then computes the state, which may use only a
  // small fraction of the total time.
  [[nodiscard]] bool due(double time, double end);
  void show(const ProgressState& state);
  // Prints a separate line above the bar.
  void warning(const std::string& text);
  // Ends the bar.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  bool terminal_;
  bool drawn_ = false;
  double begin_, last_share_ = 0.0;
  double work_ = 0.0;   // time to show the last state, including the caller's part [s]
  double begun_ = 0.0;  // start of that work, in CPU time [s]
  Clock::time_point start_, last_;
};

// "1 h 02 min", "3 min 20 s", "12 s".
std::string duration_text(double seconds);

}  // namespace thawslide::app
