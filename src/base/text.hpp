// Small functions of text, and quoting of words in printed shell commands, because paths may contain any character.
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

// Advice if a text is a number with a decimal comma, such as "; write a decimal point: 12.5"; otherwise empty.
[[nodiscard]] inline std::string comma_advice(std::string text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos || text.find_first_not_of("0123456789+-eE,") != std::string::npos ||
      text.find(',', comma + 1) != std::string::npos) {
    return "";
  }
  text[comma] = '.';
  return "; write a decimal point: " + text;
}

// Last component of a path.
[[nodiscard]] inline std::string name_of_file(std::string_view path) {
  return std::string(path.substr(path.rfind('/') + 1));
}

// Text with the letters A to Z in lower case, independent of the locale.
[[nodiscard]] inline std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

// Text as one word of a POSIX shell; a leading dash gets the prefix "./", so that it is no option.
[[nodiscard]] std::string shell_quote(const std::string& text);

}  // namespace thawslide
