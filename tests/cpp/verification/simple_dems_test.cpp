// Slides on simple DEMs: planes, planes with noise, and channels with a straight thalweg. The walls of a bend carry
// more than the weight of the material in it. Noise on the points acts as friction, unless it is filtered.
#include "channel_on_dem.hpp"
#include "plane_on_dem.hpp"
#ifdef THAWSLIDE_WITH_GIS
#include "rough_dem.hpp"
#endif

namespace thawslide::verification {
namespace {

TEST(PlaneOnDem, SlidesOrSticks) {
  using namespace plane_on_dem;
  Record record = make_record("Block on planes of a DEM");
  expect_slide(record, {15.0, 22.5}, 10.0);
  const Slide along_x = expect_slide(record, {30.0, 0.0}, 15.0);
  const Slide oblique = expect_slide(record, {30.0, 217.5}, 15.0);
  record.expect_near("acceleration in two directions, over one another", oblique.acceleration / along_x.acceleration,
                     1.0, 1e-3);
  expect_slide(record, {30.0, 100.0}, 10.0, 4e4);
  expect_slide(record, {45.0, 290.0}, 20.0);
  expect_rest(record, {45.0, 52.5}, 50.0);
}

TEST(VChannelOnDem, FrictionIsThatOfAWedge) {
  using namespace channel_on_dem;
  Record record = make_record("V channels on a DEM");
  expect_wedge(record, 120.0, 8.0, {45.0, 0.0});
  expect_wedge(record, 90.0, 8.0, {22.5, 0.0});
  expect_wedge(record, 60.0, 8.0, {22.5, 0.0});
  expect_wedge(record, 60.0, 8.0, {0.0, 2.5}, 0.05);
  record.explain("In a narrow V whose thalweg is halfway between two columns of nodes, friction is lower.");
}

TEST(VChannelOnDem, FrictionOfALooseFillIsThatOfAWedge) {
  using namespace channel_on_dem;
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
  using namespace channel_on_dem;
  Record record("U channel on a DEM", "The same with a section of half a circle, 8 cells wide, filled to the brim.",
                "apparent friction over that of the ground = 4/pi", "pressure of a fluid on a half pipe");
  const Channel channel = u_channel(8.0 * channel_cell);
  record.expect_near("apparent friction over exact, elastic fill",
                     friction_in_channel(channel, elastic_rock(0.01), 1.0, 3.0) * pi / 4.0, 1.0, 0.04);
  record.expect_near("apparent friction over exact, loose fill",
                     friction_in_channel(channel, loose_rock, 1.0, 3.0) * pi / 4.0, 1.0, 0.04);
}

#ifdef THAWSLIDE_WITH_GIS
TEST(RoughDem, FilteredAddsNoFriction) {
  using namespace rough_dem;
  Record record = make_record("Noise on the points of a DEM, filtered");
  expect_no_friction_on_plane(record, 0.05, 0.5, 0.02);
  expect_no_friction_on_plane(record, 0.1, 0.5, 0.02);
  expect_no_friction_on_plane(record, 0.2, 0.5, 0.02);
  expect_no_friction_on_plane(record, 0.2, 1.0, 0.02);
  expect_wedge_with_noise(record, 0.5, 0.12);
  expect_wedge_with_noise(record, 1.0, 0.12);
  record.explain("A filter rounds the valley.");
}
#endif

}  // namespace
}  // namespace thawslide::verification
