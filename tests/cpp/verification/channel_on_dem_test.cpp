// Channels with a straight thalweg: the walls of a bend carry more than the weight of the material in it.
#include "channel_on_dem.hpp"

namespace thawslide::verification {
namespace {

using namespace channel_on_dem;

TEST(VChannelOnDem, FrictionIsThatOfAWedge) {
  Record record = make_record("V channels on a DEM");
  expect_wedge(record, 120.0, 8.0, {45.0, 0.0});
  expect_wedge(record, 90.0, 8.0, {22.5, 0.0});
  expect_wedge(record, 60.0, 8.0, {22.5, 0.0});
  expect_wedge(record, 60.0, 8.0, {0.0, 2.5}, 0.05);
  record.explain("In a narrow V whose thalweg is halfway between two columns of nodes, friction is lower.");
}

TEST(VChannelOnDem, FrictionOfALooseFillIsThatOfAWedge) {
  Record record("V channels on a DEM, loose fill",
                "The same with a fill without cohesion, friction angle 35 degrees, 8 cells wide, thalweg on a grid "
                "line. In the narrow one the fill settles first: mean from 2 to 4 s.",
                "apparent friction over that of the ground = 1/sin(a), a half the opening angle", "wedge in a groove");
  for (const double opening : {120.0, 90.0, 60.0}) {
    const bool settles = opening == 60.0;
    const double found = friction_in_channel(v_channel(0.5 * opening, 8.0 * channel_cell), loose_rock,
                                             settles ? 2.0 : 1.0, settles ? 4.0 : 3.0);
    record.expect_near(fmt::format("apparent friction over exact, opening {} degrees", opening),
                       found / wedge_factor(opening), 1.0, settles ? 0.05 : 0.03);
  }
}

TEST(UChannelOnDem, FrictionIsThatOfAHalfPipe) {
  Record record("U channel on a DEM", "The same with a section of half a circle, 8 cells wide, filled to the brim.",
                "apparent friction over that of the ground = 4/pi", "pressure of a fluid on a half pipe");
  const Channel channel = u_channel(8.0 * channel_cell);
  record.expect_near("apparent friction over exact, elastic fill",
                     friction_in_channel(channel, elastic_rock(0.01), 1.0, 3.0) * pi / 4.0, 1.0, 0.04);
  record.expect_near("apparent friction over exact, loose fill",
                     friction_in_channel(channel, loose_rock, 1.0, 3.0) * pi / 4.0, 1.0, 0.04);
}

}  // namespace
}  // namespace thawslide::verification
