#include "app/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <ctime>

#include "app/print.hpp"
#include "base/rounding.hpp"

namespace thawslide::app {

namespace {

constexpr double seconds_between_bars = 0.2;
constexpr double seconds_between_lines = 10.0;
constexpr double share_between_lines = 0.1;
constexpr int bar_width = 24;

// CPU time of this thread: the cost of a line, independent of the load of the machine.
double thread_seconds() {
  timespec spent{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &spent);
  return static_cast<double>(spent.tv_sec) + 1e-9 * static_cast<double>(spent.tv_nsec);
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

std::string duration_text(double seconds) {
  constexpr double minute = 60.0, hour = 3600.0, day = 86400.0, year = 365.25 * day;
  if (seconds < 100.0) {
    return fmt::format("{:.0f} s", seconds);
  }
  return seconds < 100.0 * minute ? rounded_text(seconds / minute) + " min"
         : seconds < 2.0 * day    ? rounded_text(seconds / hour) + " h"
         : seconds < 2.0 * year   ? rounded_text(seconds / day) + " days"
                                  : rounded_text(seconds / year) + " years";
}

Progress::Progress(double begin)
    : terminal_(isatty(STDOUT_FILENO) != 0), begin_(begin), start_(Clock::now()), last_(start_) {}

bool Progress::due(double time, double end) {
  constexpr double least_work_between = 20.0;  // in multiples of the cost of the last line
  const double share = (time - begin_) / (end - begin_), passed = seconds_since(last_);
  const bool is_due = terminal_ ? passed >= seconds_between_bars
                                : share - last_share_ >= share_between_lines || passed >= seconds_between_lines;
  begun_ = thread_seconds();
  return is_due && passed >= least_work_between * work_;
}

void Progress::show(const ProgressState& state) {
  const double elapsed = seconds_since(start_);
  const double share = (state.time - begin_) / (state.end - begin_);
  const double left = share > 0.0 ? elapsed * (1.0 - share) / share : 0.0;
  std::string text = fmt::format("{:.1f} of {:g} s | {:.0f} steps/s | {} left", state.time, state.end,
                                 static_cast<double>(state.steps) / elapsed, duration_text(left));
  if (std::isfinite(state.front_position)) {  // in 3D it is undefined before the slide has moved
    text += fmt::format(" | front {:.0f} m", state.front_position);
  }
  if (std::isfinite(state.front_speed)) {  // it is undefined before the second position of the front
    text += fmt::format(" at {:.1f} m/s", state.front_speed);
  }
  if (terminal_) {
    const auto filled = static_cast<std::size_t>(share * bar_width);
    print_text("\r\033[K[{:<{}}] {:3.0f} % | {}", std::string(filled, '='), bar_width, 100.0 * share, text);
    drawn_ = true;
  } else {
    print_text("{:3.0f} % | {}\n", 100.0 * share, text);
  }
  last_ = Clock::now();
  work_ = thread_seconds() - begun_;
  last_share_ = share;
}

void Progress::warning(const std::string& text) {
  print_text("{}{}\n", drawn_ ? "\r\033[K" : "", text);
  drawn_ = false;
}

void Progress::finish() {
  if (drawn_) {
    print_text("\n");
    drawn_ = false;
  }
}

}  // namespace thawslide::app
