// Substrates in the case file: accepted keys and error messages.
#include "case_messages.hpp"
#include "config/describe.hpp"
#include "config/strips.hpp"
#include "physics/basal/laws.hpp"

namespace thawslide::config {
namespace {

using namespace case_messages;
using testing_support::case_from_text;

const std::string coefficient = "friction = \"coefficient\"\nfriction_coefficient = 0.1\n";
// The added text begins at line 22 of the case.
std::string on_glacier(const std::string& place) { return valid_case + "[substrate.ice]\n" + place + coefficient; }
std::string on_map(const std::string& place) { return valid_case_on_dem + "[substrate.ice]\n" + place + coefficient; }

TEST(Substrates, HaveSeparateLawsAndAreas) {
  const Case found =
      case_from_text(on_glacier("x_min = 50.0\n") + "cohesion = 1e4\ncohesion_law = \"ice\"\n" +
                     "[substrate.moraine]\nx_max = 50.0\nfriction = \"constant\"\nfriction_angle = 30\n");
  ASSERT_EQ(found.substrates.size(), 2U);
  const Substrate &ice = found.substrates.at("ice"), &moraine = found.substrates.at("moraine");
  EXPECT_EQ(ice.friction, "coefficient");
  EXPECT_EQ(ice.numbers(physics::basal::friction_coefficient), 0.1);
  EXPECT_EQ(ice.numbers(physics::basal::initial_cohesion), 1e4);
  EXPECT_EQ(ice.x_min, 50.0);
  EXPECT_TRUE(std::isinf(ice.x_max));
  EXPECT_EQ(moraine.numbers(physics::basal::friction_angle), 30.0);
  EXPECT_EQ(moraine.numbers(physics::basal::initial_cohesion), 0.0) << "the value of [basal] is not inherited";
  EXPECT_TRUE(warnings_of_gaps(found).empty());
  EXPECT_EQ(found.basal.friction, "lubricated");
}

TEST(Substrates, AreReadBackFromTheResolvedCase) {
  write_map_files();
  for (const std::string& text :
       {on_glacier("x_min = 50.0\n"), on_map("outline = \"release.geojson\"\npolygons = [\"a\"]\n"),
        on_map("raster = \"map.tif\"\ncode = 3\n")}) {
    const std::string resolved = resolved_toml(case_from_text(text), ".");
    EXPECT_EQ(resolved_toml(case_from_text(resolved), "."), resolved);
  }
  const std::string resolved = resolved_toml(case_from_text(on_glacier("x_min = 50.0\n")), "inputs");
  EXPECT_NE(resolved.find("\n[substrate.ice]\nx_min = 50.0  # m\nfriction = \"coefficient\"\nlubrication_exponent"),
            std::string::npos)
      << resolved;
  EXPECT_EQ(resolved_toml(case_from_text(valid_case), "inputs").find("substrate"), std::string::npos);
}

TEST(Substrates, NeedAnArea) {
  EXPECT_EQ(error_of_text(on_glacier("")),
            "FOLDER/case.toml:22:1: [substrate.ice] does not specify its area. Give x_min, x_max or both; [basal] "
            "applies everywhere else.");
  write_map_files();
  EXPECT_EQ(error_of_text(on_map("")),
            "FOLDER/case.toml:24:1: [substrate.ice] does not specify its area. Give x_min, x_max or both, or outline, "
            "or raster and code; [basal] applies everywhere else.");
}

TEST(Substrates, MustLieInTheDomain) {
  EXPECT_EQ(error_of_text(on_glacier("x_min = 50.0\nx_max = 50.0\n")),
            "FOLDER/case.toml:24:9: substrate.ice.x_max is 50 m, not above substrate.ice.x_min, which is 50 m; a "
            "substrate lies between them. Make the one larger or the other smaller.");
  EXPECT_EQ(error_of_text(on_glacier("x_min = 1000.0\n")),
            "FOLDER/case.toml:23:9: substrate.ice.x_min is 1000 m, and the domain reaches from x = 0 to 100 m; the "
            "substrate lies outside. Check the number, or widen the domain.");
  EXPECT_EQ(error_of_text(on_glacier("x_max = 0.0\n")),
            "FOLDER/case.toml:23:9: substrate.ice.x_max is 0 m, and the domain reaches from x = 0 to 100 m; the "
            "substrate lies outside. Check the number, or widen the domain.");
}

TEST(Substrates, MayNotOverlapNorLeaveAGapBelowACell) {
  const auto with = [](double x_min) {
    return on_glacier("x_max = 50.0\n") + fmt::format("[substrate.snow]\nx_min = {}\n{}", x_min, coefficient);
  };
  EXPECT_EQ(error_of_text(with(49.0)),
            "FOLDER/case.toml:27:9: the substrates ice and snow overlap: substrate.snow.x_min is 49 m, and "
            "substrate.ice.x_max is 50 m; a place has one substrate. End the one where the other begins.");
  EXPECT_EQ(
      error_of_text(with(50.5)),
      "FOLDER/case.toml:27:9: between the substrates ice and snow there is a gap of 0.5 m, less than a cell of the "
      "grid: substrate.ice.x_max is 50 m, and substrate.snow.x_min is 50.5 m. Let them meet, or leave a gap of "
      "at least 5 m.");
  EXPECT_TRUE(warnings_of_gaps(case_from_text(with(50.0))).empty());
  EXPECT_EQ(
      warnings_of_gaps(case_from_text(with(60.0))),
      std::vector<std::string>{
          "between the substrates ice and snow, from x = 50 to 60 m, there is no substrate: [basal] applies there"});
}

TEST(Substrates, OnMapsNeedADem) {
  write_map_files();
  const std::string in_space = changed({{"[time]", "[case]\ndimension = 3\n[time]"},
                                        {"min = [0.0, -10.0]", "min = [0.0, 0.0, -10.0]"},
                                        {"max = [100.0, 50.0]", "max = [100.0, 50.0, 50.0]"},
                                        {"min = [0.0, 0.0]", "min = [0.0, 0.0, 0.0]"},
                                        {"max = [40.0, 20.0]", "max = [40.0, 20.0, 10.0]"}});
  EXPECT_EQ(
      error_of_text(in_space + "[substrate.ice]\noutline = \"release.geojson\"\n" + coefficient),
      "FOLDER/case.toml:25:11: substrate.ice.outline is given, and terrain.type is not \"dem\"; maps lie on a DEM. "
      "Give x_min and x_max instead, or set terrain.type = \"dem\" and terrain.file.");
  EXPECT_EQ(error_of_text(on_map("outline = \"release.geojson\"\nraster = \"map.tif\"\ncode = 1\n")),
            "FOLDER/case.toml:26:10: substrate.ice.outline and substrate.ice.raster are both given; allowed: one of "
            "them, since each says where the substrate lies. Remove one.");
  EXPECT_EQ(error_of_text(on_map("raster = \"map.tif\"\n")),
            "FOLDER/case.toml:24:1: key 'substrate.ice.code' is missing: it is needed when raster is given. Add 'code "
            "= ...' to [substrate.ice]: code of the substrate in the raster, a whole number.");
  EXPECT_EQ(error_of_text(on_map("raster = \"map.tif\"\ncode = 3000000000\n")),
            "FOLDER/case.toml:26:8: substrate.ice.code is 3000000000; allowed: whole numbers up to 2147483647 (code of "
            "the substrate in the raster).");
  EXPECT_EQ(error_of_text(on_map("raster = \"map.tif\"\ncode = 1\n") +
                          "[substrate.snow]\nraster = \"map.tif\"\ncode = 1\n" + coefficient),
            "FOLDER/case.toml:31:8: substrate.ice.code and substrate.snow.code are both 1, of the same raster; a place "
            "has one substrate. Give each a code of its own.");
  EXPECT_EQ(error_of_text(on_map("outline = \"release.geojson\"\nx_min = 3.0\n")),
            "FOLDER/case.toml:26:9: substrate.ice.x_min has a meaning only when neither outline nor raster is given. "
            "Remove it, or change substrate.ice.outline.");
}

TEST(Substrates, NeedATerrainAndTheParametersOfTheirLaws) {
  EXPECT_EQ(error_of_changed({{"type = \"flat\"\nelevation = 0.0\n", ""},
                              {"[basal]\n", "[substrate.ice]\nx_min = 50.0\n" + coefficient + "[basal]\n"}}),
            "FOLDER/case.toml:18:1: [substrate.ice] specifies what bodies slide on, and the case has no terrain. "
            "Remove it, or give terrain.type.");
  EXPECT_EQ(
      error_of_text(valid_case + "[substrate.ice]\nx_min = 50.0\nfriction = \"coefficient\"\n"),
      "FOLDER/case.toml:22:1: key 'substrate.ice.friction_coefficient' is missing: it is needed when there is a "
      "terrain and friction is \"coefficient\" or \"voellmy\". Add 'friction_coefficient = ...' to [substrate.ice]: "
      "friction coefficient mu of the laws \"coefficient\" and \"voellmy\", a number, >= 0.");
  EXPECT_EQ(
      error_of_text(valid_case + "[substrate.ice]\nx_min = 50.0\nfriction_coefficient = 0.1\nfriction_angle = 5.0\n"),
      "FOLDER/case.toml:24:24: substrate.ice.friction_coefficient has a meaning only when friction is "
      "\"coefficient\" or \"voellmy\". Remove it, or change substrate.ice.friction.");
  EXPECT_EQ(
      error_of_text(valid_case + "[substrate.ice]\nx_min = 50.0\nfriction = \"voellmy\"\nfriction_coefficient = 0.1\n"),
      "FOLDER/case.toml:22:1: key 'substrate.ice.turbulent_friction' is missing: it is needed when there is a "
      "terrain and friction is \"voellmy\". Add 'turbulent_friction = ...' to [substrate.ice]: turbulent friction "
      "xi of the law \"voellmy\"; a larger value reduces the drag rho g v^2/xi, a number, > 0 [m/s2].");
  EXPECT_EQ(error_of_text(valid_case + "[substrate.ice]\nx_min = 50.0\n" + coefficient + "turbulent_friction = 500\n"),
            "FOLDER/case.toml:26:22: substrate.ice.turbulent_friction has a meaning only when friction is \"voellmy\". "
            "Remove it, or change substrate.ice.friction.");
  EXPECT_EQ(
      error_of_text(on_glacier("x_min = 50.0\n") + "cohesion = 1.0\nresidual_cohesion = 2.0\nslip_distance = 1.0\n"),
      "FOLDER/case.toml:27:21: substrate.ice.residual_cohesion is 2 Pa, above substrate.ice.cohesion, which is 1 "
      "Pa; cohesion along the ground is only lost. Give a residual at most the cohesion.");
}

}  // namespace
}  // namespace thawslide::config
