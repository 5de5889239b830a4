// A block on planes of a DEM, all slopes and directions.
#include "../verification/plane_on_dem.hpp"

namespace thawslide::verification {
namespace {

using namespace plane_on_dem;

// By the symmetries of the square, the azimuths represent 0, 7.5, 15, ... 45 degrees.
TEST(PlanesOnDem, SlidesOrSticksOnAllAlike) {
  Record record = make_record("Block on planes of a DEM, four slopes and eight directions");
  for (const double slope : {0.0, 15.0, 30.0, 45.0}) {
    double least = HUGE_VAL, greatest = -HUGE_VAL;
    for (int k = 0; k < 8; ++k) {
      const Plane plane{slope, 52.5 * k};
      if (slope == 0.0 || k == 3) {
        expect_rest(record, plane, slope + 5.0);
      }
      if (slope > 0.0) {
        const double acceleration = expect_slide(record, plane, 0.5 * slope).acceleration;
        least = std::min(least, acceleration);
        greatest = std::max(greatest, acceleration);
      }
    }
    if (slope > 0.0) {
      record.expect_near(fmt::format("spread of the acceleration over all directions, {} degrees", slope),
                         (greatest - least) / greatest, 0.0, 1e-3);
    }
  }
}

// Cohesion depends on the contact area, which is closer to that of the base on smaller cells.
const std::vector<std::string> half_cells{"grid.cell=2.5", "time.step=0.0005", "material.debris.viscosity_time=0.01"};

TEST(PlanesOnDem, CohesionBrakesInAllDirections) {
  Record record = make_record("Block with cohesion on planes of a DEM");
  for (const double azimuth : {0.0, 52.5, 105.0, 157.5}) {
    expect_slide(record, {30.0, azimuth}, 10.0, 4e4, half_cells);
  }
}

}  // namespace
}  // namespace thawslide::verification
