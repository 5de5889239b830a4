// A width that varies along x, its warning, and the width in the resolved case.
#include "case_messages.hpp"
#include "config/describe.hpp"
#include "config/notices.hpp"

namespace thawslide::config {
namespace {

using namespace case_messages;

std::string with_width(const std::string& width) { return "[case]\nwidth = " + width + "\n" + valid_case; }
const std::string widening = "{ x = [10.0, 60.0], value = [20.0, 40.0] }";

TEST(Width, IsOneNumberOrATableOverX) {
  const WidthOverX one = testing_support::case_from_text(with_width("617.0")).general.width;
  EXPECT_FALSE(one.varies());
  EXPECT_EQ(one.reference(), 617.0);
  const Case table = testing_support::case_from_text(with_width(widening));
  EXPECT_TRUE(table.general.width.varies());
  EXPECT_EQ(table.general.width.table.value, (std::vector<double>{20.0, 40.0}));
  EXPECT_EQ(table.general.width.factor(), 20.0) << "results are per metre of the first";
  EXPECT_EQ(testing_support::case_from_text(valid_case).general.width.factor(), 1.0) << "none is given";
}

TEST(Width, IsWrittenAsItWasRead) {
  const Case table = testing_support::case_from_text(with_width(widening));
  EXPECT_NE(resolved_toml(table, {}).find("width = " + widening + "  # m\n"), std::string::npos);
}

TEST(Width, CausesAWarningIfItWidensSteeply) {
  const auto warnings = [](const std::string& width) {
    std::vector<std::string> found;
    for (const std::string& warning : implausible(testing_support::case_from_text(with_width(width)))) {
      if (warning.find("case.width") != std::string::npos) {
        found.push_back(warning.substr(warning.find("case.toml")));
      }
    }
    return found;
  };
  EXPECT_EQ(warnings("{ x = [10.0, 60.0], value = [20.0, 70.0] }"), std::vector<std::string>{});
  EXPECT_EQ(warnings("{ x = [10.0, 60.0], value = [170.0, 20.0] }"),
            (std::vector<std::string>{
                "case.toml:2:9: case.width is 170 m at x = 10 m and 20 m at x = 60 m: it changes by 3 m per m. The "
                "neglected lateral motion would have 0.75 of the kinetic energy there. Spread the change of width over "
                "a longer distance."}));
}

}  // namespace
}  // namespace thawslide::config
