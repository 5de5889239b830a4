// Small functions of text.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace thawslide {

// Text without blanks at both ends.
[[nodiscard]] inline std::string trimmed(std::string_view text) {
  constexpr const char* blanks = " \t\v\f\r";
  const std::size_t first = text.find_first_not_of(blanks);
  return first == std::string_view::npos ? ""
                                         : std::string(text.substr(first, text.find_last_not_of(blanks) - first + 1));
}

// Text with the letters A to Z in lower case, independent of the locale.
[[nodiscard]] inline std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

}  // namespace thawslide
