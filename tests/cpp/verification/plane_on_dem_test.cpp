// A block on planes of a DEM.
#include "plane_on_dem.hpp"

namespace thawslide::verification {
namespace {

using namespace plane_on_dem;

TEST(PlaneOnDem, SlidesOrSticks) {
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

}  // namespace
}  // namespace thawslide::verification
