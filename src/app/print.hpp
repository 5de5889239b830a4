// What is told as the work goes on. Where nobody reads it any more (a closed pipe, a full disk) the work goes on; of
// commands whose results are what they print, main.cpp tells at their end that these were lost.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>

namespace thawslide::app {

// A stream that does not take it is no failure.
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
