#include "base/text.hpp"

#include <cctype>

namespace thawslide {

namespace {

// Bytes beyond ASCII have no special meaning in a shell.
bool is_plain(unsigned char letter) {
  return letter >= 0x80 || std::isalnum(letter) != 0 ||
         std::string_view("_-./:=@%+,").find(static_cast<char>(letter)) != std::string_view::npos;
}

}  // namespace

std::string shell_quote(const std::string& text) {
  const std::string word = text.rfind('-', 0) == 0 ? "./" + text : text;
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) {
    return word;
  }
  std::string quoted = "'";
  for (const char letter : word) {
    quoted += letter == '\'' ? "'\\''" : std::string(1, letter);
  }
  return quoted + "'";
}

}  // namespace thawslide
