// Output during the work. If it cannot be written (a closed pipe, a full disk), the work continues. For commands whose
// results are their output, main.cpp reports the loss at the end.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>

namespace thawslide::app {

// Ignores a stream that cannot be written.
inline void put(std::FILE* stream, const std::string& text) {
  (void)std::fwrite(text.data(), 1, text.size(), stream);
  (void)std::fflush(stream);
}

template <class... Values>
void print_text(fmt::format_string<Values...> format, Values&&... values) {
  put(stdout, fmt::format(format, std::forward<Values>(values)...));
}

template <class... Values>
void print_error(fmt::format_string<Values...> format, Values&&... values) {
  put(stderr, fmt::format(format, std::forward<Values>(values)...));
}

}  // namespace thawslide::app
