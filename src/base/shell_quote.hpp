// Quoting of words in printed shell commands, because paths may contain any character.
#pragma once

#include <string>

namespace thawslide {

// Text as one word of a POSIX shell, quoted if it contains special characters. A leading dash gets the prefix "./", so
// that no program interprets the path as an option.
[[nodiscard]] std::string shell_quote(const std::string& text);

}  // namespace thawslide
