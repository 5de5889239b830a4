// Warnings name what cells that follow the terrain do not represent.
#include "sim/unresolved_terrain.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "../support/messages.hpp"
#include "../support/slide_on_dem.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

// Release of 20 m at x < -40 m.
Simulation<3> slide_on(const Height& height, double cell, bool follows = true) {
  const Place half(200.0, 100.0);
  const auto slide = release_on_dem({20.0, 0.01, cell, {-200.0, -100.0, -300.0}, {200.0, 100.0, 300.0}}, {}, 20.0);
  const Raster thickness = thickness_between(
      -half, half, 5.0, [](double x, double y) { return std::hypot(x + 80.0, y) < 35.0 ? 20.0 : 0.0; });
  return Simulation<3>(case_on_dem(slide, fmt::format("grid.follows_terrain={}; time.stepping=adaptive", follows)),
                       site_of(raster_between(-half, half, 1.25, height), thickness));
}

std::vector<std::string> warnings_on(const Height& height, double cell, bool follows = true) {
  const Simulation<3> simulation = slide_on(height, cell, follows);
  return warnings_of_unresolved_terrain(simulation);
}

double cliff(double x, double /*y*/) { return -0.3 * x + std::clamp(6.0 * (20.0 - x), 0.0, 60.0); }

TEST(UnresolvedTerrain, ReportsColumnsThatWereLowered) {
  const auto warnings = warnings_on(cliff, 5.0);
  ASSERT_EQ(warnings.size(), 1U);
  expect_in(warnings[0], "grid.steepest: the terrain is steeper than 65 degrees. Columns of nodes lowered: ");
  expect_in(warnings[0], "m at x = 10 m, y = ");
}

TEST(UnresolvedTerrain, IsNotReportedOnGentleTerrainOrLevelCells) {
  EXPECT_TRUE(warnings_on([](double x, double) { return -0.3 * x; }, 5.0).empty());
  EXPECT_TRUE(warnings_on(cliff, 5.0, false).empty());
}

}  // namespace
}  // namespace thawslide::sim
