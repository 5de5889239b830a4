// V channels of three openings and two widths, with the thalweg on and between grid lines and oblique to them.
#include "../verification/channel_on_dem.hpp"

namespace thawslide::verification {
namespace {

using namespace channel_on_dem;

TEST(VChannelsOnDem, HoldAsTheWedgeSays) {
  Record record = make_record("V channels on a DEM: openings, widths and directions");
  for (const double cells : {8.0, 4.0}) {
    for (const double opening : {120.0, 90.0, 60.0}) {
      for (const Course& course : {Course{0.0, 0.0}, Course{0.0, 2.5}, Course{22.5, 0.0}, Course{45.0, 0.0}}) {
        expect_wedge(record, opening, cells, course);
      }
    }
  }
}

}  // namespace
}  // namespace thawslide::verification
