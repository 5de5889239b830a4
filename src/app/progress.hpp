// How far a run is: a bar on a terminal, plain lines elsewhere.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace thawslide::app {

// What a progress line tells.
struct ProgressState {
  double time, end;  // simulated [s]
  std::int64_t steps;
  double front_position, front_speed;  // [m], [m/s]; NaN while not known
};

class Progress {
 public:
  // `begin`: simulated time the run starts at [s].
  explicit Progress(double begin);

  // True if enough wall time has passed for a new line: the caller then works out the state, which may take no more
  // than a small share of all time.
  [[nodiscard]] bool due(double time, double end);
  void show(const ProgressState& state);
  // A line of its own above the bar.
  void warning(const std::string& text);
  // Ends the bar.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  bool terminal_;
  bool drawn_ = false;
  double begin_, last_share_ = 0.0;
  double work_ = 0.0;   // to show the last state, the caller's part too [s]
  double begun_ = 0.0;  // the work, in processor time [s]
  Clock::time_point start_, last_;
};

// "1 h 02 min", "3 min 20 s", "12 s".
std::string duration_text(double seconds);

}  // namespace thawslide::app
