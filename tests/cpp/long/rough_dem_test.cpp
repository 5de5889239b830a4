// Noise of many amplitudes on the points of a DEM, filtered.
#ifdef THAWSLIDE_WITH_GIS
#include "../verification/rough_dem.hpp"

namespace thawslide::verification {
namespace {

using namespace rough_dem;

TEST(RoughDems, FilteredAddNoFriction) {
  Record record = make_record("Noise on the points of a DEM, filtered: sizes and distances of points");
  for (const double spacing : {1.0, 0.5}) {
    for (const double noise : {0.05, 0.1, 0.2, 0.5}) {
      for (const unsigned seed : {3U, 4U, 5U}) {
        expect_no_friction_on_plane(record, noise, spacing, noise < 0.5 ? 0.03 : 0.05, seed);
      }
    }
  }
}

}  // namespace
}  // namespace thawslide::verification
#endif
