// Base of a block in a valley: channels with known factors; planes and ridges with a factor of 1. The motion of the
// block is in tests/cli/block_test.py.
#include "sim/checks/valley_factor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/slide_on_dem.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

constexpr double degree = 3.14159265358979323846 / 180.0, slope = 35.0, cell = 5.0;

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

}  // namespace
}  // namespace thawslide::sim
