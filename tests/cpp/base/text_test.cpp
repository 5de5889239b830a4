// A shell reads each quoted text as a single word with the same characters.
#include "base/text.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <memory>

namespace thawslide {
namespace {

// The word as read by bash.
std::string read_by_bash(const std::string& word) {
  const std::string command = "bash -c \"$(cat <<'END'\nprintf %s " + word + "\nEND\n)\"";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"), &pclose);
  std::array<char, 256> read{};
  const std::size_t bytes = pipe ? std::fread(read.data(), 1, read.size(), pipe.get()) : 0;
  return {read.data(), bytes};
}

TEST(ShellQuote, LeavesPlainPathsUnchanged) {
  for (const std::string path : {"runs/small", "../a_b-c.toml", "/tmp/x,y@z+1%", "time.end=5", "h\xC3\xBCtte"}) {
    EXPECT_EQ(shell_quote(path), path);
  }
}

TEST(ShellQuote, QuotesSpecialCharacters) {
  EXPECT_EQ(shell_quote("o/a b"), "'o/a b'");
  EXPECT_EQ(shell_quote("o/$(id)"), "'o/$(id)'");
  EXPECT_EQ(shell_quote("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_quote(""), "''");
  EXPECT_EQ(shell_quote("~"), "'~'");
  EXPECT_EQ(shell_quote("-x"), "./-x") << "no option";
}

TEST(ShellQuote, IsReadBackUnchanged) {
  for (const std::string text : {"a b", "$(id)", "`id`", "it's", "a\"b", "back\\slash", "a;b&c|d<e>f*?[g]{h,i}!#~",
                                 "two\nlines", "tab\tand ' and \\ and \x1b[2J"}) {
    EXPECT_EQ(read_by_bash(shell_quote(text)), text);
  }
}

}  // namespace
}  // namespace thawslide
