// Error messages for invalid beds.
#include "case_messages.hpp"

namespace thawslide::config {
namespace {

using namespace case_messages;

const std::string bed =
    "[bed]\nlaw = \"momentum\"\ndepth = 2.0\nstrength = 1e3\ndepth_per_slip = 0.5\nmaterial = \"rock\"\n";

std::string error_of_bed(const std::string& from, const std::string& to) {
  std::string changed_bed = bed;
  changed_bed.replace(changed_bed.find(from), from.size(), to);
  return error_of_text(valid_case + changed_bed);
}

TEST(Bed, ThatIsValidHasNoError) {
  EXPECT_EQ(error_of_text(valid_case + bed), "no error");
  EXPECT_EQ(error_of_bed("2.0", "{ x = [0.0, 50.0], value = [0.0, 2.0] }"), "no error");
}

TEST(Bed, LawWithoutStrengthIsRefused) {
  EXPECT_EQ(error_of_bed("strength = 1e3\n", ""),
            "FOLDER/case.toml:22:1: key 'bed.strength' is missing: it is needed when bed.law is not \"none\". Add "
            "'strength = ...' to [bed]: shear strength c_b of the bed without load, a number, >= 0 [Pa].");
}

TEST(Bed, WithoutMaterialIsRefused) {
  EXPECT_EQ(error_of_bed("material = \"rock\"\n", ""),
            "FOLDER/case.toml:22:1: key 'bed.material' is missing: it is needed when bed.law is not \"none\". Add "
            "'material = ...' to [bed]: name of the bed's material, a text in quotes.");
  EXPECT_EQ(error_of_bed("\"rock\"", "\"rok\""),
            "FOLDER/case.toml:27:12: bed.material is 'rok', and there is no [material.rok]; did you mean 'rock'? "
            "Allowed: rock.");
}

TEST(Bed, DeeperThanACellIsRefused) {
  EXPECT_EQ(error_of_bed("2.0", "6.0"),
            "FOLDER/case.toml:24:9: bed.depth is 6 m, more than grid.cell, which is 5 m; the ground is not lowered as "
            "the bed is entrained. Make the bed thinner, or represent the bed by a body on lower terrain.");
}

TEST(Bed, DepthMustDependOnXOrBeARaster) {
  EXPECT_EQ(error_of_bed("2.0", "{ depth = [0.0, 1.0], value = [1.0, 1.0] }"),
            "FOLDER/case.toml:24:9: bed.depth is given by depth; allowed: a number, { x = [...], value = [...] } or { "
            "raster = \"FILE\" }, since a bed has no polygons and lies on the ground.");
  EXPECT_EQ(error_of_bed("2.0", "{ raster = \"case.toml\" }"),
            "FOLDER/case.toml:24:9: bed.depth is a raster, and terrain.type is not \"dem\"; maps lie on a DEM. Give a "
            "number or a table over x, or set terrain.type = \"dem\" and terrain.file.");
}

TEST(Bed, WithoutLawOrTerrainIsRefused) {
  EXPECT_EQ(error_of_text(valid_case + "[bed]\ndepth = 2.0\n"),
            "FOLDER/case.toml:23:9: bed.depth has a meaning only when bed.law is not \"none\". Remove it, or change "
            "bed.law.");
  EXPECT_NE(error_of_text(changed({{"type = \"flat\"\nelevation = 0.0", "type = \"none\""},
                                   {"[basal]\nfriction_angle = 20.0\n", ""}}) +
                          bed)
                .find("bed.law is given, and the case has no terrain that a bed could lie on. Remove [bed], or give "
                      "terrain.type."),
            std::string::npos);
}

}  // namespace
}  // namespace thawslide::config
