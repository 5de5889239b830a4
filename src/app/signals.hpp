// Ctrl-C and kill: a run ends its step, writes what it has and stops with exit code 4.
#pragma once

namespace thawslide::app {

// From now on SIGINT, SIGTERM and SIGHUP only set a mark; a second one, of any of them, ends the program at once. One
// that is ignored already, as nohup has it, stays ignored.
void catch_signals();

// From now on a pipe that nobody reads and a file above its size limit are errors of the call that writes, which by
// themselves would end the program.
void survive_failing_writes();

// The signal that came, 0 if none.
int caught_signal();

}  // namespace thawslide::app
