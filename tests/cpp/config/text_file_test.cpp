// Text files, readable and unreadable, and texts of users in messages.
#include <gtest/gtest.h>

#include "case_messages.hpp"
#include "config/input_limits.hpp"

namespace thawslide::config {
namespace {

std::string refusal_of(const std::filesystem::path& file) {
  return case_messages::error_of([&] { return read_text_file(file); });
}

TEST(TextFile, IsReadUnchanged) {
  const std::string text = std::string("one\r\ntwo") + '\0' + "\xFF";
  case_messages::write_next_to_the_case("text.txt", text);
  case_messages::write_next_to_the_case("empty.txt", "");
  EXPECT_EQ(read_text_file(case_messages::folder_of_this_test() / "text.txt"), text);
  EXPECT_EQ(read_text_file(case_messages::folder_of_this_test() / "empty.txt"), "");
}

TEST(TextFile, ThatIsUnreadableIsReportedWithTheReason) {
  EXPECT_EQ(refusal_of("/nowhere/case.toml"),
            "/nowhere/case.toml: cannot be read: No such file or directory. Check that the file is whole and may be "
            "read.");
  EXPECT_EQ(refusal_of("/proc/self/mem"),
            "/proc/self/mem: cannot be read: Invalid argument. Check that the file is whole and may be read.")
      << "it opens, and its first byte is an error";
}

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
