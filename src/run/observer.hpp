// Receiver of the lines and the progress of a run, which may interrupt it: the terminal, or an object in Python.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace thawslide::run {

// Contents of a progress line.
struct ProgressState {
  double time, end;  // simulated [s]
  std::int64_t steps;
  double front_position, front_speed;  // [m], [m/s]; NaN while unknown
};

class Observer {
 public:
  virtual ~Observer() = default;

  // The time loop begins at a simulated time [s]; from now on, `interruption` is asked.
  virtual void start(double /*time*/) {}
  // One line, without its end. Warnings begin with "warning: ", information with "note: ".
  virtual void text(const std::string& line) = 0;
  // The same for the reason why a run ended early.
  virtual void error(const std::string& line) = 0;
  // Called after every step: true if a progress line is due, whose state may cost a small fraction of the total time.
  virtual bool wants_progress(double /*time*/, double /*end*/) { return false; }
  virtual void progress(const ProgressState& /*state*/) {}
  virtual void end_progress() {}
  // Reason to stop after the present step, such as "signal 2"; empty: the run continues.
  virtual std::string interruption() { return ""; }

  // Several lines with the same beginning.
  void texts(const std::string& begin, const std::vector<std::string>& lines) {
    for (const std::string& each : lines) {
      text(begin + each);
    }
  }
  template <class... Values>
  void line(fmt::format_string<Values...> form, Values&&... values) {
    text(fmt::format(form, std::forward<Values>(values)...));
  }
  template <class... Values>
  void error_line(fmt::format_string<Values...> form, Values&&... values) {
    error(fmt::format(form, std::forward<Values>(values)...));
  }
};

}  // namespace thawslide::run
