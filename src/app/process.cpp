#include "app/process.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <initializer_list>

namespace thawslide::app {

namespace fs = std::filesystem;

namespace {

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

void catch_signals() {
  for (const int number : signals) {
    answer(number, remember);
  }
}

void survive_size_limits() { std::signal(SIGXFSZ, SIG_IGN); }

void survive_closed_pipes() { std::signal(SIGPIPE, SIG_IGN); }

int caught_signal() { return signal_number; }

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
