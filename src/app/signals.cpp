#include "app/signals.hpp"

#include <csignal>
#include <initializer_list>

namespace thawslide::app {

namespace {

volatile std::sig_atomic_t signal_number = 0;

void remember(int number) {
  signal_number = number;
  std::signal(number, SIG_DFL);
}

}  // namespace

void catch_signals() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    std::signal(number, remember);
  }
}

int caught_signal() { return signal_number; }

}  // namespace thawslide::app
