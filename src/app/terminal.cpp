#include "app/terminal.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <filesystem>

#include "base/clocks.hpp"
#include "base/rounding.hpp"

namespace thawslide::app {

namespace fs = std::filesystem;

namespace {

constexpr double seconds_between_bars = 0.2;
constexpr double seconds_between_lines = 10.0;
constexpr double fraction_between_lines = 0.1;
constexpr int bar_width = 24;

volatile std::sig_atomic_t signal_number = 0;

constexpr int signals[] = {SIGINT, SIGTERM, SIGHUP};

// A signal that the parent process ignores, as under nohup, remains ignored.
void answer(int number, void (*handler)(int)) {
  if (std::signal(number, handler) == SIG_IGN) {
    std::signal(number, SIG_IGN);
  }
}

void remember(int number) {
  signal_number = number;
  for (const int each : signals) {
    answer(each, SIG_DFL);
  }
}

}  // namespace

Terminal::Terminal() : is_terminal_(isatty(STDOUT_FILENO) != 0), start_(wall_clock()), last_(start_) {}

void Terminal::start(double time) {
  for (const int number : signals) {
    answer(number, remember);
  }
  begin_ = time;
  last_fraction_ = 0.0;
  start_ = last_ = wall_clock();
}

std::string Terminal::interruption() {
  return signal_number == 0 ? std::string() : fmt::format("signal {}", static_cast<int>(signal_number));
}

bool Terminal::wants_progress(double time, double end) {
  constexpr double least_work_between = 20.0;  // in multiples of the cost of the last line
  const double fraction = (time - begin_) / (end - begin_), passed = wall_clock() - last_;
  const bool is_due = is_terminal_
                          ? passed >= seconds_between_bars
                          : fraction - last_fraction_ >= fraction_between_lines || passed >= seconds_between_lines;
  begun_ = thread_clock();
  return is_due && passed >= least_work_between * work_;
}

void Terminal::progress(const run::ProgressState& state) {
  const double elapsed = wall_clock() - start_;
  const double fraction = (state.time - begin_) / (state.end - begin_);
  const double left = fraction > 0.0 ? elapsed * (1.0 - fraction) / fraction : 0.0;
  std::string text = fmt::format("{:.1f} of {:g} s | {:.0f} steps/s | {} left", state.time, state.end,
                                 static_cast<double>(state.steps) / elapsed, duration_text(left));
  if (std::isfinite(state.front_position)) {  // in 3D it is undefined before the slide has moved
    text += fmt::format(" | front {:.0f} m", state.front_position);
  }
  if (std::isfinite(state.front_speed)) {  // it is undefined before the second position of the front
    text += fmt::format(" at {:.1f} m/s", state.front_speed);
  }
  if (is_terminal_) {
    const auto filled = static_cast<std::size_t>(fraction * bar_width);
    print_text("\r\033[K[{:<{}}] {:3.0f} % | {}", std::string(filled, '='), bar_width, 100.0 * fraction, text);
    is_drawn_ = true;
  } else {
    print_text("{:3.0f} % | {}\n", 100.0 * fraction, text);
  }
  last_ = wall_clock();
  work_ = thread_clock() - begun_;
  last_fraction_ = fraction;
}

void Terminal::text(const std::string& line) {
  print_text("{}{}\n", is_drawn_ ? "\r\033[K" : "", line);
  is_drawn_ = false;
}

void Terminal::error(const std::string& line) {
  end_progress();
  print_error("{}\n", line);
}

void Terminal::end_progress() {
  if (is_drawn_) {
    print_text("\n");
    is_drawn_ = false;
  }
}

void open_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) == -1) {
      // Opens /dev/null as the lowest free descriptor, which is this stream, in the direction in which access fails.
      static_cast<void>(open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY));
    }
  }
}

const char* const python_program_remedy =
    "It is part of the Python package: `./run --setup` installs it into .venv; put .venv/bin on PATH.";

std::string python_program(const std::string& name) {
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  // The build folder of a checkout is build/PRESET.
  for (const fs::path& candidate : {folder / name, folder / ".." / ".." / ".venv" / "bin" / name}) {
    if (!folder.empty() && access(candidate.c_str(), X_OK) == 0) {
      return candidate.string();
    }
  }
  return name;
}

}  // namespace thawslide::app
