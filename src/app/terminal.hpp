// Run on a terminal or in a log: lines, progress as a bar on a terminal and as plain lines otherwise. Signals and
// standard streams of the process, and programs of the Python package. Ctrl-C and kill: a run completes its step,
// writes its state and stops with exit code 4.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>

#include "run/observer.hpp"

namespace thawslide::app {

class Terminal final : public run::Observer {
 public:
  Terminal();

  // From the first call on, SIGINT, SIGTERM and SIGHUP interrupt the run; a second one ends the program immediately.
  // Signals that are already ignored, as under nohup, remain ignored.
  void start(double time) override;
  void text(const std::string& line) override;
  void error(const std::string& line) override;
  [[nodiscard]] bool wants_progress(double time, double end) override;
  void progress(const run::ProgressState& state) override;
  void end_progress() override;
  [[nodiscard]] std::string interruption() override;

 private:
  bool is_terminal_;
  bool is_drawn_ = false;
  double begin_ = 0.0, last_fraction_ = 0.0;
  double work_ = 0.0;    // time to show the last state, including the caller's part [s]
  double begun_ = 0.0;   // start of that work, in CPU time [s]
  double start_, last_;  // wall-clock time [s]
};

// Occupies standard streams that the parent process has closed, so that no later file takes their descriptors and
// receives messages. Reading and writing such a stream fails as before.
void open_standard_streams();

// Path of a program such as thawslide-report next to this program, as in an installed package, or in the .venv of the
// checkout in which this program was built; otherwise its name, which is then searched on PATH.
std::string python_program(const std::string& name);

// "It is part of ...": where to get such a program, for messages.
extern const char* const python_program_remedy;

// Output during the work. If it cannot be written (a closed pipe, a full disk), the work continues. For commands whose
// results are their output, main.cpp reports the loss at the end.
// Ignores a stream that cannot be written.
inline void put(std::FILE* stream, const std::string& text) {
  (void)std::fwrite(text.data(), 1, text.size(), stream);
  (void)std::fflush(stream);
}

template <class... Values>
void print_text(fmt::format_string<Values...> format, Values&&... values) {
  put(stdout, fmt::format(format, std::forward<Values>(values)...));
}

template <class... Values>
void print_error(fmt::format_string<Values...> format, Values&&... values) {
  put(stderr, fmt::format(format, std::forward<Values>(values)...));
}

}  // namespace thawslide::app
