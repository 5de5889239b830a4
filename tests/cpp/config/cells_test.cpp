// Cells that follow the terrain exclude options that are not available on them, in one message.
#include "case_messages.hpp"

namespace thawslide::config {
namespace {

using namespace case_messages;

const std::string following = changed({{"[grid]", "[grid]\nfollows_terrain = true"}});

TEST(Cells, FollowTheTerrainOnRequest) {
  EXPECT_FALSE(testing_support::case_from_text(valid_case).grid.follows_terrain);
  EXPECT_TRUE(testing_support::case_from_text(following).grid.follows_terrain);
}

TEST(Cells, ThatFollowTheTerrainListAllUnavailableOptions) {
  const std::string more =
      "[mechanics]\nshape_function = \"quadratic\"\n"
      "[frame.wall]\nmin = [90.0, 0.0]\nmax = [95.0, 20.0]\naxis = \"x\"\nvelocity = 0.0\n";
  EXPECT_EQ(error_of_text(following + more),
            "FOLDER/case.toml:5:19: grid.follows_terrain: cells that follow the terrain do not support all options of "
            "this case (found mechanics.shape_function other than \"ugimp\", a [frame]; allowed: none of these). Set "
            "grid.follows_terrain = false.");
}

TEST(Cells, DoNotFollowAPlaneAboveTheirSlopeLimit) {
  const std::string plane = changed({{"[grid]", "[grid]\nfollows_terrain = true\nsteepest = 60"},
                                     {"type = \"flat\"", "type = \"plane\"\nslope = 70"}});
  EXPECT_EQ(
      error_of_text(plane),
      "FOLDER/case.toml:12:9: terrain.slope is 70 degrees, steeper than cells may follow the terrain (grid.steepest is "
      "60 degrees; allowed: up to 85). Increase grid.steepest, or set grid.follows_terrain = false.");
}

}  // namespace
}  // namespace thawslide::config
