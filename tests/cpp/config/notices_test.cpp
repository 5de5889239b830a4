// Warnings about values that are valid but unusual.
#include "config/notices.hpp"

#include "case_messages.hpp"
#include "config/describe.hpp"

namespace thawslide::config {
namespace {

using namespace case_messages;
using testing_support::case_from_text;

// The case of a run folder contains every default and marks the given ones.
TEST(Notices, WarnOfADefaultOfAResolvedCase) {
  const std::string known = "pressure.frozen=none";
  const std::string text = changed({{"[basal]", "[band]\nthickness = 0.5\n[basal]"},
                                    {"law = \"elastic\"", "law = \"elastic\"\ngaps_close_first = true"}});
  for (const std::string given : {"", "hydraulic_conductivity = 0.0\n"}) {
    const std::string first = changed({{"gaps_close_first", given + "gaps_close_first"}}, text);
    const std::string resolved = resolved_toml(case_from_text(first, {known}), "inputs");
    const Case again = case_from_text(resolved);
    EXPECT_EQ(resolved_toml(again, "inputs"), resolved);
    const std::vector<std::string> found = notices(again);
    ASSERT_EQ(found.size(), given.empty() ? 1U : 0U);
    if (given.empty()) {
      EXPECT_NE(found[0].find("material.rock.hydraulic_conductivity is 0 m/s, its default: pore water cannot drain"),
                std::string::npos);
    }
  }
}

}  // namespace
}  // namespace thawslide::config
