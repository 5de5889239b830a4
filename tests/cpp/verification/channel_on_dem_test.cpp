// Channels of straight thalweg: the walls of a bend of the ground carry more than the weight of what lies in it.
#include "../support/channel_on_dem.hpp"

#include <gtest/gtest.h>

#include "../support/record.hpp"

namespace thawslide::verification {
namespace {

using namespace testing_support;
constexpr double degree = pi<double> / 180.0;

double wedge_factor(double half_opening) { return 1.0 / std::sin(half_opening * degree); }

TEST(VChannelOnDem, WallsHoldAsTheWedgeSays) {
  Record record("V channels on a DEM",
                "An elastic fill, 60 m long, in a channel of V section that falls by 35 degrees, friction angle of the "
                "ground 15 degrees, cells of 5 m, points of the DEM each 1.25 m. The thalweg is on a grid line, "
                "between two, or oblique to them. Mean from 1 to 3 s.",
                "apparent friction over that of the ground = 1/sin(a), a half the opening angle", "wedge in a groove");
  for (const double cells : {8.0, 4.0}) {
    for (const double opening : {120.0, 90.0, 60.0}) {
      for (const auto& [azimuth, aside] :
           {std::pair(0.0, 0.0), std::pair(0.0, 2.5), std::pair(22.5, 0.0), std::pair(45.0, 0.0)}) {
        Channel channel = v_channel(0.5 * opening, cells * channel_cell);
        channel.azimuth = azimuth;
        channel.aside = aside;
        const double found = friction_in_channel(channel, elastic_rock(0.01), 1.0, 3.0);
        record.expect_near(
            fmt::format("apparent friction over exact, opening {} degrees, {} cells wide, thalweg at {} degrees{}",
                        opening, cells, azimuth, aside > 0.0 ? ", between grid lines" : ""),
            found / wedge_factor(0.5 * opening), 1.0, cells == 8.0 ? 0.02 : 0.03);
      }
    }
  }
}

TEST(VChannelOnDem, LooseFill) {
  Record record(
      "V channels on a DEM, loose fill",
      "The same with a fill without cohesion, friction angle 35 degrees, 8 cells wide, thalweg on a grid line.",
      "apparent friction over that of the ground = 1/sin(a), a half the opening angle", "wedge in a groove");
  for (const double opening : {120.0, 90.0, 60.0}) {
    const double found = opening == 60.0 ? friction_in_channel(v_channel(30.0, 40.0), loose_rock, 2.0, 4.0)
                                         : friction_in_channel(v_channel(0.5 * opening, 40.0), loose_rock, 1.0, 3.0);
    record.expect_near(fmt::format("apparent friction over exact, opening {} degrees", opening),
                       found / wedge_factor(0.5 * opening), 1.0, opening == 60.0 ? 0.05 : 0.03);
  }
}

TEST(UChannelOnDem, WallsHoldAsInAHalfPipe) {
  Record record("U channel on a DEM", "The same with a section of half a circle, 8 cells wide, filled to the brim.",
                "apparent friction over that of the ground = 4/pi", "pressure of a fluid on a half pipe");
  record.expect_near("apparent friction over exact, elastic",
                     friction_in_channel(u_channel(40.0), elastic_rock(0.01), 1.0, 3.0) * pi<double> / 4.0, 1.0, 0.04);
  record.expect_near("apparent friction over exact, loose",
                     friction_in_channel(u_channel(40.0), loose_rock, 1.0, 3.0) * pi<double> / 4.0, 1.0, 0.04);
}

}  // namespace
}  // namespace thawslide::verification
