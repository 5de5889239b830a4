// Run on a terminal or in a log, with its progress and signals, and programs of the Python package. Ctrl-C and kill: a
// run completes its step, writes its state and stops with exit code 4.
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

  // From here on, SIGINT, SIGTERM and SIGHUP, unless ignored, interrupt the run; a second one ends the program.
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

// Occupies standard streams that the parent has closed, so that no file takes their descriptors and gets messages.
void open_standard_streams();

// Path of a program such as thawslide-report: next to this one, in .venv of its checkout, or its name, for PATH.
std::string python_program(const std::string& name);

// "It is part of ...": where to get such a program, for messages.
extern const char* const python_program_remedy;

// Output during the work, which continues if it cannot be written. main.cpp reports lost results of other commands.
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
