// Sections through a DEM along a line.
#include "sim/block/section.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "../support/messages.hpp"
#include "../support/small_terrain.hpp"

namespace thawslide::sim {
namespace {

using testing_support::raster;

const PathLine bent({{0.0, 0.0}, {10.0, 0.0}, {10.0, 7.0}});

void expect_stations(const std::vector<double>& stations, const std::vector<double>& expected) {
  ASSERT_EQ(stations.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_DOUBLE_EQ(stations[k], expected[k]);
  }
}

TEST(Section, StationsKeepTheCornersAndAreCloseEnough) {
  expect_stations(stations_along(bent, 0.0, 17.0, 3.0),
                  {0.0, 2.5, 5.0, 7.5, 10.0, 10.0 + 7.0 / 3.0, 10.0 + 14.0 / 3.0, 17.0});
}

TEST(Section, StationsAreExtrapolatedBeyondTheEnds) {
  expect_stations(stations_along(bent, -4.0, 19.0, 4.0), {-4.0, 0.0, 10.0 / 3.0, 20.0 / 3.0, 10.0, 13.5, 17.0, 19.0});
}

TEST(Section, GroundFollowsTheTriangles) {
  // One raised corner of a cell of 4 m: the centre is the mean of the four corners, a fourth of the raised one.
  const Raster ground =
      raster(0.0, 0.0, 4.0, 3, 3, [](double x, double y) { return x == 4.0 && y == 4.0 ? 8.0 : 0.0; });
  const PathLine diagonal({{0.0, 0.0}, {4.0, 4.0}});
  const double length = diagonal.length();
  const auto elevations = ground_along(diagonal, {0.0, 0.25 * length, 0.5 * length, 0.75 * length, length}, ground);
  const double expected[] = {0.0, 1.0, 2.0, 5.0, 8.0};
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_NEAR(elevations[k], expected[k], 1e-12);
  }
}

// Cut out of the ground or placed on it: the loss of one equals the gain of the other.
TEST(Section, GroundAndThicknessSumToTheTriangulatedSum) {
  const Raster ground = testing_support::rough_raster();
  const Raster thickness = raster(0.0, 0.0, 5.0, 5, 5, [](double x, double y) {
    return x == 0.0 || y == 0.0 || x == 20.0 || y == 20.0 ? 0.0 : 3.0 + 0.1 * x * y;
  });
  Raster top = ground;
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 5; ++column) {
      top.values[top.index(4 + column, 3 + row)] += thickness.at(column, row);
    }
  }
  const PathLine line({{-18.0, -13.0}, {7.0, 9.0}, {70.0, 60.0}});
  const auto stations = stations_along(line, 0.0, line.length(), 1.7);
  const auto below = ground_along(line, stations, ground), above = ground_along(line, stations, top);
  const auto between = thickness_along(line, stations, thickness);
  double largest = 0.0;
  for (std::size_t k = 0; k < stations.size(); ++k) {
    EXPECT_NEAR(above[k] - below[k], between[k], 1e-11);
    largest = std::max(largest, between[k]);
  }
  EXPECT_GT(largest, 10.0);
  EXPECT_EQ(between.front(), 0.0);
  EXPECT_EQ(between.back(), 0.0);
}

std::string error_of(const PathLine& line, double to, const Raster& ground) {
  const auto stations = stations_along(line, 0.0, line.length(), 1.0);
  return testing_support::error_of(
      [&] { require_known(line, stations, ground_along(line, stations, ground), to, ground, "--line: way.gpkg"); });
}

TEST(Section, ReportsWhereTheGroundEnds) {
  Raster ground = raster(0.0, 0.0, 2.0, 6, 6, [](double x, double) { return x; });
  const PathLine line({{1.0, 3.0}, {14.0, 3.0}});
  EXPECT_EQ(error_of(line, 13.0, ground),
            "--line: way.gpkg: the line is outside the DEM 10 m from its beginning, at x = 11, y = 3; its "
            "points reach from x = 0 to 10 and from y = 0 to 10. Draw the line within them, or take a larger DEM.");
  EXPECT_EQ(error_of(line, 9.0, ground), "no error") << "only as far as it must be known";
  ground.values[ground.index(3, 2)] = std::nan("");
  EXPECT_EQ(error_of(line, 13.0, ground),
            "--line: way.gpkg: the line crosses a place without data 3 m from its beginning, at x = 4, y = 3; needed: "
            "an elevation all along it. Fill the DEM there (gdal_fillnodata.py), or draw the line around "
            "it.");
}

}  // namespace
}  // namespace thawslide::sim
