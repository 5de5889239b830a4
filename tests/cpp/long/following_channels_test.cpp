// Channels in cells that follow the ground, at several angles to the grid.
#include "../support/channel_on_dem.hpp"
#include "../verification/verification.hpp"

namespace thawslide::verification {
namespace {

// Apparent friction over that of the ground: an elastic fill, or one without cohesion.
double friction(Channel channel, double azimuth, bool is_loose, double from = 1.0) {
  channel.azimuth = azimuth;
  return friction_in_channel(channel, is_loose ? loose_rock : elastic_rock(0.01), from, from + 2.0);
}

TEST(FollowingChannels, HaveTheFrictionOfAWedge) {
  Record record("Cells that follow the ground: channels at several angles to the grid",
                "A fill slides in a channel that falls by 35 degrees and is 8 cells of 5 m wide. The friction angle of "
                "the ground is 15 degrees, and points of the DEM are 1.25 m apart. Mean from 1 to 3 s; a loose fill "
                "settles first in the narrow V: from 2 to 4 s.",
                "apparent friction over that of the ground = 1/sin(a), a half the opening angle of a V; 4/pi in a half "
                "pipe",
                "wedge in a groove");
  for (const bool is_loose : {false, true}) {
    const char* fill = is_loose ? "loose" : "elastic";
    for (const double azimuth : {0.0, 15.0, 22.5, 33.0, 45.0}) {
      for (const double opening : {120.0, 105.0, 90.0, 75.0}) {
        record.expect_near(
            fmt::format("apparent friction over exact, {} fill, opening {} degrees, thalweg at {} degrees to the grid",
                        fill, opening, azimuth),
            friction(v_channel(0.5 * opening, 8.0 * channel_cell), azimuth, is_loose) * std::sin(opening * pi / 360.0),
            1.0, is_loose ? 0.03 : 0.02);
      }
    }
    record.expect_near(fmt::format("apparent friction over exact, {} fill, opening 60 degrees", fill),
                       friction(v_channel(30.0, 8.0 * channel_cell), 0.0, is_loose, is_loose ? 2.0 : 1.0) * 0.5, 1.0,
                       0.03);
    record.expect_near(fmt::format("apparent friction over exact, {} fill, half pipe", fill),
                       friction(u_channel(8.0 * channel_cell), 0.0, is_loose) * pi / 4.0, 1.0, 0.03);
  }
}

}  // namespace
}  // namespace thawslide::verification
