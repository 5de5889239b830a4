// Ctrl-C and kill: a run ends its step, writes what it has and stops with exit code 4.
#pragma once

namespace thawslide::app {

// From now on SIGINT, SIGTERM and SIGHUP only set a mark; a second one, of any of them, ends the program at once. One
// that is ignored already, as nohup has it, stays ignored.
void catch_signals();

// From now on a file above its size limit, or a pipe that nobody reads, is an error of the call that writes, which by
// itself would end the program.
void survive_size_limits();
void survive_closed_pipes();

// The signal that came, 0 if none.
int caught_signal();

}  // namespace thawslide::app
