// Cells that follow the terrain exclude options that are not available on them, in one message.
#include "case_messages.hpp"

namespace thawslide::config {
namespace {

using namespace case_messages;

TEST(Cells, ThatFollowTheTerrainListAllUnavailableOptions) {
  const std::string more =
      "[grid.boundary]\ny_max = \"roller\"\n[heat.boundary]\ny_min = { temperature = -5.0 }\n"
      "[frame.wall]\nmin = [90.0, 0.0]\nmax = [95.0, 20.0]\naxis = \"x\"\nvelocity = 0.0\n";
  EXPECT_EQ(error_of_text(changed({{"type = \"flat\"", "type = \"plane\"\nslope = 5"}}) + more),
            "FOLDER/case.toml:9:8: terrain.type: cells that follow the terrain do not support all options of this case "
            "(found a [frame] on ground that is not flat, grid.boundary at the bottom or top of the domain, "
            "heat.boundary at the bottom or top of the domain; allowed: none of these). Remove them: the terrain is "
            "the lower boundary. A [frame] needs terrain.type = \"flat\".");
}

TEST(Cells, DoNotFollowAPlaneAboveTheirSlopeLimit) {
  const std::string plane =
      changed({{"[grid]", "[grid]\nsteepest = 60"}, {"type = \"flat\"", "type = \"plane\"\nslope = 70"}});
  EXPECT_EQ(
      error_of_text(plane),
      "FOLDER/case.toml:11:9: terrain.slope is 70 degrees, steeper than cells may follow the terrain (grid.steepest is "
      "60 degrees; allowed: up to 85). Increase grid.steepest, or reduce terrain.slope.");
}

}  // namespace
}  // namespace thawslide::config
