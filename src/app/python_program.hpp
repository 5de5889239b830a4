// Location of the programs of the Python package.
#pragma once

#include <string>

namespace thawslide::app {

// Path of a program such as thawslide-report next to this program, as in an installed package, or in the .venv of the
// checkout in which this program was built; otherwise its name, which is then searched on PATH.
std::string python_program(const std::string& name);

// "It is part of ...": where to get such a program, for messages.
extern const char* const python_program_remedy;

}  // namespace thawslide::app
