// Noise on the points of a DEM acts as friction, unless it is filtered.
#ifdef THAWSLIDE_WITH_GIS
#include "rough_dem.hpp"

namespace thawslide::verification {
namespace {

using namespace rough_dem;

TEST(RoughDem, FilteredAddsNoFriction) {
  Record record = make_record("Noise on the points of a DEM, filtered");
  expect_no_friction_on_plane(record, 0.05, 0.5, 0.02);
  expect_no_friction_on_plane(record, 0.1, 0.5, 0.02);
  expect_no_friction_on_plane(record, 0.2, 0.5, 0.02);
  expect_no_friction_on_plane(record, 0.2, 1.0, 0.02);
  expect_wedge_with_noise(record, 0.5, 0.12);
  expect_wedge_with_noise(record, 1.0, 0.12);
  record.explain("A filter rounds the valley.");
}

}  // namespace
}  // namespace thawslide::verification
#endif
