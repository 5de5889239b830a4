// Ctrl-C and kill: a run ends its step, writes what it has and stops with exit code 4.
#pragma once

namespace thawslide::app {

// From now on SIGINT, SIGTERM and SIGHUP only set a mark; a second one ends the program at once.
void catch_signals();

// The signal that came, 0 if none.
int caught_signal();

}  // namespace thawslide::app
