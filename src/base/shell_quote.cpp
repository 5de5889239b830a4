#include "base/shell_quote.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace thawslide {

namespace {

bool is_control(unsigned char letter) { return letter < 0x20 || letter == 0x7f; }

// Bytes beyond ASCII have no special meaning in a shell.
bool is_plain(unsigned char letter) {
  constexpr std::string_view signs = "_-./:=@%+,";
  const bool is_letter = (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') || letter >= 0x80;
  return is_letter || (letter >= '0' && letter <= '9') || signs.find(static_cast<char>(letter)) != signs.npos;
}

// 'it'\''s'
std::string in_quotes(const std::string& word) {
  std::string quoted = "'";
  for (const char letter : word) {
    quoted += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
  }
  return quoted + "'";
}

// $'two\012lines': control characters are written as octal escapes, because they would affect a terminal.
std::string with_escapes(const std::string& word) {
  std::string quoted = "$'";
  for (const char letter : word) {
    const auto byte = static_cast<unsigned char>(letter);
    quoted += is_control(byte)                   ? fmt::format("\\{:03o}", static_cast<unsigned>(byte))
              : letter == '\'' || letter == '\\' ? std::string{'\\', letter}
                                                 : std::string(1, letter);
  }
  return quoted + "'";
}

}  // namespace

std::string shell_quote(const std::string& text) {
  const std::string word = text.rfind('-', 0) == 0 ? "./" + text : text;
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) {
    return word;
  }
  return std::any_of(word.begin(), word.end(), is_control) ? with_escapes(word) : in_quotes(word);
}

}  // namespace thawslide
