#include "base/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

namespace thawslide {

namespace {

bool is_control(unsigned char letter) { return letter < 0x20 || letter == 0x7f; }

// Bytes beyond ASCII have no special meaning in a shell.
bool is_plain(unsigned char letter) {
  return letter >= 0x80 || std::isalnum(letter) != 0 ||
         std::string_view("_-./:=@%+,").find(static_cast<char>(letter)) != std::string_view::npos;
}

// 'it'\''s', or $'two\012lines': control characters are written as octal escapes, because they would affect a terminal.
std::string in_quotes(const std::string& word, bool has_control) {
  std::string quoted = has_control ? "$'" : "'";
  for (const char letter : word) {
    const auto byte = static_cast<unsigned char>(letter);
    const bool is_escaped = letter == '\'' || (has_control && letter == '\\');
    quoted += is_control(byte) ? fmt::format("\\{:03o}", static_cast<unsigned>(byte))
              : !is_escaped    ? std::string(1, letter)
              : has_control    ? std::string{'\\', letter}
                               : "'\\''";
  }
  return quoted + "'";
}

}  // namespace

std::string shell_quote(const std::string& text) {
  const std::string word = text.rfind('-', 0) == 0 ? "./" + text : text;
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) {
    return word;
  }
  return in_quotes(word, std::any_of(word.begin(), word.end(), is_control));
}

}  // namespace thawslide
