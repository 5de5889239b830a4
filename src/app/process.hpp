// Signals and standard streams of the process, and programs of the Python package. Ctrl-C and kill: a run completes its
// step, writes its state and stops with exit code 4.
#pragma once

#include <string>

namespace thawslide::app {

// SIGINT, SIGTERM and SIGHUP only set a flag from now on; a second one of any of them ends the program immediately.
// Signals that are already ignored, as under nohup, remain ignored.
void catch_signals();

// A file above its size limit, or a pipe without a reader, becomes an error of the writing call instead of ending the
// program.
void survive_size_limits();
void survive_closed_pipes();

// Signal received, 0 if none.
int caught_signal();

// Occupies standard streams that the parent process has closed, so that no later file takes their descriptors and
// receives messages. Reading and writing such a stream fails as before.
void open_standard_streams();

// Path of a program such as thawslide-report next to this program, as in an installed package, or in the .venv of the
// checkout in which this program was built; otherwise its name, which is then searched on PATH.
std::string python_program(const std::string& name);

// "It is part of ...": where to get such a program, for messages.
extern const char* const python_program_remedy;

}  // namespace thawslide::app
