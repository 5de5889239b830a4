#include "config/input_limits.hpp"

#include <gtest/gtest.h>

namespace thawslide::config {
namespace {

TEST(InputLimits, TerminalControlCharactersAreReplaced) {
  EXPECT_EQ(printable("a\x1b[2J\x7f\n\tb"), "a?[2J???b");
  EXPECT_EQ(printable("a\x1b[2J\n\tb", "\n\t"), "a?[2J\n\tb");
  EXPECT_EQ(printable("left \u202e right \u2069 \u202f"), "left ? right ? \u202f") << "a space that is no mark stays";
  EXPECT_EQ(printable("gl\u00e4cier"), "gl\u00e4cier");
}

TEST(InputLimits, LongTextsAreCut) {
  const std::string most(most_letters_quoted, 'x');
  EXPECT_EQ(shown(most), most);
  EXPECT_EQ(shown(most + "y"), most + "...");
  EXPECT_EQ(shown("\a" + most), "?" + most.substr(1) + "...");
}

}  // namespace
}  // namespace thawslide::config
