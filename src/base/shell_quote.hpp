// Words of a command line that is told to be pasted into a shell: paths may hold anything, and others name files.
#pragma once

#include <string>

namespace thawslide {

// The text as one word of a POSIX shell: itself where nothing in it means anything to a shell, else in quotes. One that
// begins with a dash gets "./" before it, so that no program takes the path for an option.
[[nodiscard]] std::string shell_quote(const std::string& text);

}  // namespace thawslide
