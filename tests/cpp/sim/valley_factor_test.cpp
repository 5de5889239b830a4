// Base of a block in a valley: channels with known factors; planes and ridges with a factor of 1.
#include "sim/checks/valley_factor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/slide_on_dem.hpp"
#include "sim/block/block.hpp"
#include "sim/block/path_section.hpp"

namespace thawslide::sim {
namespace {

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
