// Errors and warnings for a section whose width varies along x, and the width in the resolved case.
#include "case_messages.hpp"
#include "config/describe.hpp"
#include "config/plausibility.hpp"

namespace thawslide::config {
namespace {

using namespace case_messages;

std::string with_width(const std::string& width) { return "[case]\nwidth = " + width + "\n" + valid_case; }
std::string error_of(const std::string& width, const std::string& more = "") {
  return error_of_text(with_width(width) + more);
}
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

TEST(Width, RefusesInvalidTables) {
  const std::string allowed = "; allowed: a number or { x = [...], value = [...] }, >= 0 [m]",
                    at = "FOLDER/case.toml:2:", or_default = ". Correct it, or leave it out for the default 0.0.";
  EXPECT_EQ(error_of("{ x = [10.0, 60.0] }"), at + "9: case.width is a table with the keys x" + allowed + or_default);
  EXPECT_EQ(error_of("\"wide\""), at + "9: case.width is the text \"wide\"" + allowed + or_default);
  EXPECT_EQ(
      error_of("{ x = [10.0, 60.0], value = [20.0] }"),
      at + "9: case.width has 2 entries of x and 1 of value; allowed: as many of both, at least one" + or_default);
  EXPECT_EQ(error_of("{ x = [60.0, 10.0], value = [20.0, 40.0] }"),
            at + "22: case.width holds x 10 after 60; allowed: strictly increasing" + or_default);
  EXPECT_EQ(error_of("{ x = [10.0, 10.0], value = [20.0, 40.0] }"),
            at + "22: case.width holds x 10 after 10; allowed: strictly increasing" + or_default);
  EXPECT_EQ(error_of("{ x = [10.0, 60.0], value = [20.0, 0.0] }"),
            at + "44: case.width holds the value 0 at x = 60; allowed in a table: > 0" + or_default);
  EXPECT_NE(error_of("{ x = [10.0, 60.0], value = [20.0, -1.0] }").find(at + "44: case.width is -1; allowed: >= 0 m"),
            std::string::npos);
}

TEST(Width, ThatVariesRefusesOptionsNotVerifiedWithIt) {
  const auto refused = [](const std::string& what) {
    return "FOLDER/case.toml:2:9: case.width: a width that varies along x and " + what +
           " exclude each other. Give one width, or remove the latter.";
  };
  const std::string frame = "[frame.wall]\nmin = [60.0, 0.0]\nmax = [70.0, 20.0]\naxis = \"x\"\nvelocity = 0.0\n";
  EXPECT_EQ(error_of(widening, frame), refused("a rigid frame ([frame.NAME])"));
  EXPECT_EQ(error_of(widening,
                     "[bed]\nlaw = \"strength\"\ndepth = 1.0\nstrength = 1e3\nfriction_angle = 10.0\ndepth_per_slip = "
                     "0.1\nmaterial = \"rock\"\n"),
            refused("an erodible bed ([bed])"));
  const std::string apart =
      "[body.ice]\nmaterial = \"rock\"\nmin = [40.0, 0.0]\nmax = [50.0, 20.0]\n"
      "[contact]\nbetween_bodies = \"frictional\"\nfriction_angle = 20.0\n";
  EXPECT_EQ(error_of(widening, apart), refused("frictional contact between bodies ([contact])"));
  EXPECT_EQ(error_of("20.0", frame), "no error");
}

TEST(Width, IsForSectionsOnly) {
  write_map_files();
  EXPECT_EQ(
      error_of_text(changed({{"[case]\n", "[case]\nwidth = 617.0\n"}}, valid_case_on_dem)),
      "FOLDER/case.toml:2:9: case.width has a meaning only in two dimensions, and case.dimension is 3. Remove it.");
  EXPECT_EQ(
      error_of_text(changed({{"[case]\n", "[case]\nwidth = " + widening + "\n"}}, valid_case_on_dem)),
      "FOLDER/case.toml:2:9: case.width has a meaning only in two dimensions, and case.dimension is 3. Remove it.");
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
