// Case files based on others: precedence of values, locations of errors, refused bases.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "case_messages.hpp"
#include "config/describe.hpp"
#include "physics/basal/laws.hpp"

namespace thawslide::config {
namespace {

using namespace case_messages;

void write(const std::string& name, const std::string& text) {
  std::filesystem::create_directories(folder_of_this_test());
  std::ofstream(folder_of_this_test() / name) << text;
}

Case read(const std::string& name, const std::vector<std::string>& sets = {}) {
  return read_case(folder_of_this_test() / name, sets);
}

std::string mistake(const std::string& name) {
  try {
    read(name);
  } catch (const UserError& error) {
    return error.what();
  }
  return "no mistake";
}

TEST(BasedOn, KeysAreInheritedUnlessGiven) {
  write("case.toml", valid_case);
  write("steep.toml",
        "[case]\nbased_on = \"case.toml\"\n[basal]\nfriction_angle = 35.0\n[body.block]\nmax = [60.0, 30.0]\n");
  write("steeper.toml", "[case]\nbased_on = \"steep.toml\"\n[basal]\nfriction_angle = 40.0\n");
  const Case base = read("case.toml"), steep = read("steep.toml"), steeper = read("steeper.toml");
  EXPECT_EQ(base.basal.numbers(physics::basal::friction_angle), 20.0);
  EXPECT_EQ(steep.basal.numbers(physics::basal::friction_angle), 35.0);
  EXPECT_EQ(steep.bodies.at("block").max[0], 60.0);
  EXPECT_EQ(steep.bodies.at("block").material, "rock");
  EXPECT_EQ(steep.time.end, base.time.end);
  EXPECT_EQ(steeper.basal.numbers(physics::basal::friction_angle), 40.0);
  EXPECT_EQ(steeper.bodies.at("block").max[0], 60.0);
  EXPECT_EQ(steeper.case_files.size(), 3U);
  EXPECT_EQ(read("steep.toml", {"basal.friction_angle=5"}).basal.numbers(physics::basal::friction_angle), 5.0);
}

TEST(BasedOn, ACellOfTheVariantMovesTheDomainToWholeCells) {
  write("case.toml", valid_case);
  write("coarse.toml", "[case]\nbased_on = \"case.toml\"\n[grid]\ncell = 8.0\n");
  EXPECT_EQ(read("coarse.toml").grid.max, (Point{104.0, 54.0, 0.0}));
  write("odd.toml", "[case]\nbased_on = \"case.toml\"\n[grid]\ncell = 8.0\nmax = [100.0, 50.0]\n");
  EXPECT_NE(mistake("odd.toml").find("12.5 cells of 8 m; allowed: a whole number"), std::string::npos);
}

// The ground is known inside the domain only.
TEST(BasedOn, ACellOfTheVariantShrinksADomainOnADem) {
  write_map_files();
  write("case.toml", valid_case_on_dem);
  const Grid before = read("case.toml").grid;
  const double cell = 0.9 * before.cell;
  const Grid after = read("case.toml", {fmt::format("grid.cell={}", cell)}).grid;
  for (std::size_t a = 0; a < 3; ++a) {
    const double cells = (after.max[a] - after.min[a]) / cell;
    EXPECT_NEAR(cells, std::round(cells), 1e-9);
    EXPECT_EQ(after.min[a], before.min[a]);
    EXPECT_LT(std::abs(after.max[a] - before.max[a]), cell);
    EXPECT_TRUE(a == 2 ? after.max[a] >= before.max[a] : after.max[a] <= before.max[a]);
  }
}

TEST(BasedOn, AValueThatIsATableIsReplacedAsAWhole) {
  write_map_files();
  write("case.toml",
        changed({{"thickness = 10.0",
                  "thickness = { attribute = \"depth\" }\nporosity = { depth = [0, 9], value = [0.3, 0.4] }"}},
                valid_case_on_dem) +
            "[heat.boundary]\nz_min = { temperature = -2.0 }\nx_min = { flux = 1.0 }\n");
  write("maps.toml",
        "[case]\nbased_on = \"case.toml\"\n[body.slide]\nthickness = { raster = \"map.tif\" }\n"
        "porosity = { x = [0, 9], value = [0.3, 0.4] }\n[heat.boundary]\nz_min = { flux = 0.06 }\n");
  const Case found = read("maps.toml");
  EXPECT_EQ(found.bodies.at("slide").thickness.from, MapValue::From::raster);
  EXPECT_EQ(found.bodies.at("slide").porosity.over, InitialField::Over::x);
  EXPECT_EQ(found.bodies.at("slide").material, "rock") << "the enclosing table is merged";
  EXPECT_EQ(found.heat.boundary[4].kind, HeatBoundaryKind::flux);
  EXPECT_EQ(found.heat.boundary[0].value, 1.0) << "and a table inside a table";
}

TEST(BasedOn, TheResolvedCaseNeedsNoBaseCase) {
  write("case.toml", valid_case);
  write("steep.toml", "[case]\nbased_on = \"case.toml\"\n[basal]\nfriction_angle = 35.0\n");
  const std::string resolved = resolved_toml(read("steep.toml"), "inputs");
  write("alone.toml", resolved);
  std::filesystem::remove(folder_of_this_test() / "case.toml");
  EXPECT_EQ(read("alone.toml").basal.numbers(physics::basal::friction_angle), 35.0);
}

TEST(BasedOn, MistakesAreReportedAtTheirLocation) {
  const std::string folder = folder_of_this_test().string();
  write("case.toml", changed({{"end = 2.0", "end = -2.0"}}));
  write("odd.toml", "[case]\nbased_on = \"case.toml\"\n[basal]\nfriction_angel = 35.0\n");
  const std::string text = mistake("odd.toml");
  EXPECT_NE(text.find(folder + "/case.toml:2:7: time.end is -2;"), std::string::npos) << text;
  EXPECT_NE(text.find(folder + "/odd.toml:4:1: "), std::string::npos) << text;
  EXPECT_NE(text.find("did you mean 'friction_angle'?"), std::string::npos) << text;
}

TEST(BasedOn, ABaseCaseMustExistWithoutACycle) {
  const std::string folder = folder_of_this_test().string();
  write("lost.toml", "[case]\nbased_on = \"nowhere.toml\"\n");
  EXPECT_EQ(mistake("lost.toml"), folder +
                                      "/lost.toml:2:12: case.based_on is \"nowhere.toml\": no such file; allowed: "
                                      "the name of a case file of the same folder.");
  write("away.toml", "[case]\nbased_on = \"../case.toml\"\n");
  EXPECT_NE(mistake("away.toml").find("which is a path; allowed: the name of a case file of the same folder."),
            std::string::npos);
  write("one.toml", "[case]\nbased_on = \"two.toml\"\n");
  write("two.toml", "[case]\nbased_on = \"one.toml\"\n");
  EXPECT_NE(mistake("one.toml").find("two.toml:2:12: case.based_on is \"one.toml\": the chain of files forms a cycle."),
            std::string::npos)
      << mistake("one.toml");
}

}  // namespace
}  // namespace thawslide::config
