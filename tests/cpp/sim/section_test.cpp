// Sections through a DEM along a line, and the base of a block in a valley: channels with known factors, and planes and
// ridges with a factor of 1.
#include "sim/block/section.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/messages.hpp"
#include "../support/slide_on_dem.hpp"
#include "../support/small_terrain.hpp"
#include "sim/block/block.hpp"
#include "sim/block/path_section.hpp"

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

using namespace testing_support;

constexpr double degree = 3.14159265358979323846 / 180.0, slope = 35.0, friction = 15.0, cell = 5.0;

// Slope of the walls of a V-shaped channel with this opening angle normal to its thalweg.
double side_of(double opening) { return 1.0 / std::tan(0.5 * opening * degree) / std::cos(slope * degree); }

// Ground that falls by the slope towards an azimuth; `across`: height as a function of the distance from the line of
// fall through the origin.
Height channel(double azimuth, const std::function<double(double)>& across) {
  const double x = std::cos(azimuth * degree), y = std::sin(azimuth * degree), fall = std::tan(slope * degree);
  return
      [=](double east, double north) { return 1000.0 - fall * (x * east + y * north) + across(x * north - y * east); };
}

double factor_in(const Height& ground, double azimuth, const CrossSection& section, double points_apart) {
  const Place half(300.0, 300.0);
  const double x = std::cos(azimuth * degree), y = std::sin(azimuth * degree);
  const PathLine line({{-100.0 * x, -100.0 * y}, {100.0 * x, 100.0 * y}});
  const std::vector<double> factors =
      valley_factors(line, {20.0, 77.0, 133.0}, raster_between(-half, half, points_apart, ground), section);
  EXPECT_NEAR(factors[0], factors[1], 0.06 * factors[1]);
  EXPECT_NEAR(factors[2], factors[1], 0.06 * factors[1]);
  return factors[1];
}

TEST(ValleyFactor, OfAVChannelIsOneOverTheSineOfHalfItsOpening) {
  for (const double opening : {150.0, 120.0, 90.0, 60.0}) {
    const double m = side_of(opening), exact = 1.0 / std::sin(0.5 * opening * degree);
    const auto v = [m](double across) { return m * std::abs(across); };
    for (const double width : {4.0 * cell, 8.0 * cell, 20.0 * cell}) {
      for (const double fill : {0.1, 0.5, 1.0, 3.0}) {  // of the area up to the width
        SCOPED_TRACE(fmt::format("opening {}, width {}, fill {}", opening, width, fill));
        const CrossSection section{width, fill * 0.25 * m * width * width, 0.5 * cell};
        EXPECT_NEAR(factor_in(channel(0.0, v), 0.0, section, cell), exact, 1e-9) << "thalweg on the points";
        if (width >= 8.0 * cell && fill >= 0.5) {  // the triangles between the points truncate an oblique thalweg
          EXPECT_NEAR(factor_in(channel(22.5, v), 22.5, section, 0.25 * cell), exact, 0.06 * exact);
          EXPECT_NEAR(factor_in(channel(45.0, v), 45.0, section, 0.25 * cell), exact, 0.06 * exact);
        }
      }
    }
  }
}

// A circular trough on level ground, filled to a given level: int h dA / int h dx, by arc and by chord.
TEST(ValleyFactor, OfATroughWeightsTheGroundByTheDepthAboveIt) {
  const double radius = 40.0;
  for (const double half : {10.0, 20.0, 30.0}) {  // of the surface
    const double bed = radius - std::sqrt(radius * radius - half * half);
    double on_ground = 0.0, on_map = 0.0;
    constexpr int parts = 20000;
    for (int k = 0; k < parts; ++k) {
      const double x = half * (2.0 * (k + 0.5) / parts - 1.0);
      const double depth = bed - (radius - std::sqrt(radius * radius - x * x));
      on_map += depth * 2.0 * half / parts;
      on_ground += depth * 2.0 * half / parts / std::sqrt(1.0 - x * x / (radius * radius));
    }
    const Height trough = [radius](double, double y) {
      const double x = std::min(std::abs(y), 0.95 * radius);
      return radius - std::sqrt(radius * radius - x * x);
    };
    EXPECT_NEAR(factor_in(trough, 0.0, {2.2 * half, on_map, 1.0}, 1.0), on_ground / on_map, 2e-3) << half;
  }
}

TEST(ValleyFactor, OfStraightAndObliquePlanesAndOfARidgeIsOne) {
  const CrossSection section{60.0, 600.0, 2.5};
  for (const double across : {0.0, 0.3, -1.2}) {
    EXPECT_NEAR(factor_in(channel(0.0, [across](double y) { return across * y; }), 0.0, section, cell), 1.0, 1e-9);
  }
  EXPECT_EQ(factor_in(channel(0.0, [](double y) { return -std::abs(y); }), 0.0, section, cell), 1.0);
  const Height unknown = [](double x, double) { return x < 290.0 ? no_data : 1.0; };
  EXPECT_EQ(factor_in(unknown, 0.0, section, cell), 1.0);
}

// A fill of the channel that slides by Coulomb friction: a = g (sin(slope) - k tan(friction) cos(slope)).
TEST(ValleyFactor, BlockInAVChannelHasTheFrictionOfItsTwoSides) {
  for (const double opening : {120.0, 90.0, 60.0}) {
    SCOPED_TRACE(fmt::format("opening {}", opening));
    const double m = side_of(opening), factor = 1.0 / std::sin(0.5 * opening * degree), depth = 20.0 * m;
    const Height v = channel(0.0, [m](double across) { return m * std::abs(across); });
    config::Case parameters = case_on_dem(
        release_on_dem({2.0, 0.001, cell, {-200.0, -100.0, 0.0}, {300.0, 100.0, 2000.0}}, elastic_rock(0.02), friction),
        {"time.history_interval=1", "mechanics.slope_shear=false"});
    config::Site site = site_of(raster_between({-250.0, -150.0}, {350.0, 150.0}, cell, v),
                                raster_between({-100.0, -20.0}, {0.0, 20.0}, cell, [&](double, double y) {
                                  return std::max(0.0, depth - m * std::abs(y));
                                }));
    site.releases.at("slide").area = 100.0 * 40.0;
    site.path = {{-150.0, 0.0}, {300.0, 0.0}};
    const PathSection section = section_along_path(parameters, site);
    const auto rows = run_block(section.parameters, section.site, section.valley_factor);
    const double expected =
        9.81 * (std::sin(slope * degree) - factor * std::tan(friction * degree) * std::cos(slope * degree));
    EXPECT_NEAR(value_of(rows.back(), "velocity_m_s") / value_of(rows.back(), "time_s"), expected, 1e-6 * expected);
    EXPECT_NEAR(value_of(rows.back(), "valley_factor"), factor, 1e-6);
    EXPECT_NEAR(value_of(rows.front(), "sliding_strength_Pa") / value_of(rows.front(), "driving_traction_Pa"),
                factor * std::tan(friction * degree) / std::tan(slope * degree), 1e-6);
  }
}

}  // namespace
}  // namespace thawslide::sim
