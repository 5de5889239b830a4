// The ground at nodes: heights, distances, normals, and the nodal fractions of its surface and of the space above it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "terrain/profile_surface.hpp"

namespace thawslide::terrain {
namespace {

const Polyline bent({0.0, 7.3, 11.1, 30.0}, {20.0, 14.6, 9.0, 8.5});

TEST(Polyline, IsExtrapolatedWithTheGradientOfItsEnds) {
  EXPECT_DOUBLE_EQ(bent.height(-7.3), 25.4);
  EXPECT_NEAR(bent.height(48.9), 8.0, 1e-12);
  EXPECT_DOUBLE_EQ(bent.highest(5.0, 12.0), bent.height(5.0));
}

TEST(Polyline, NearestPointIsTheFootOfTheNormal) {
  const double slope = (14.6 - 20.0) / 7.3;
  const Vector<double, 2> up = Vector<double, 2>(-slope, 1.0).normalized();
  const Vector<double, 2> foot(3.0, bent.height(3.0));
  for (const double distance : {2.0, 1e-3, -1.5}) {
    const Vector<double, 2> position = foot + distance * up;
    const auto nearest = bent.nearest(position[0], position[1]);
    EXPECT_NEAR(nearest.distance, distance, 1e-12);
    EXPECT_NEAR((nearest.normal + up).norm(), 0.0, 1e-9);
  }
}

TEST(Polyline, EndSegmentsAreExtrapolatedBeyondTheirOuterEndsOnly) {
  const Polyline line({0.0, 10.0, 20.0, 30.0}, {10.0, 0.0, 0.0, 10.0});
  EXPECT_NEAR(line.nearest(12.0, -3.0).distance, -3.0, 1e-12);
  EXPECT_NEAR(line.nearest(18.0, -3.0).distance, -3.0, 1e-12);
  EXPECT_NEAR(line.nearest(-10.0, 20.0).distance, 0.0, 1e-12);
}

// The linear shape functions of a grid sum to one, and the nodal fractions therefore sum to the complete surface and
// space, except in the last columns and rows of the grid, where their sum decreases from 1 to 0.
TEST(LinearFraction, SumsToTheSurfaceAndToTheSpaceAboveIt) {
  constexpr double h = 2.0;
  constexpr int first = -3, last_column = 18, last_row = 20;
  double length = 0.0, above = 0.0;
  for (int i = first; i <= last_column; ++i) {
    for (int j = first; j <= last_row; ++j) {
      const auto fraction = bent.linear_fraction(i * h, j * h, h);
      EXPECT_GE(fraction.length, 0.0);
      EXPECT_LE(fraction.above, h * h * (1.0 + 1e-12));
      length += fraction.length;
      above += fraction.above;
    }
  }
  double expected_length = 0.0, expected_above = 0.0;
  constexpr int parts = 1000000;
  constexpr double from = (first - 1) * h, to = (last_column + 1) * h, step = (to - from) / parts;
  for (int k = 0; k < parts; ++k) {
    const double x = from + (k + 0.5) * step;
    const double columns = std::min({1.0, (x - from) / h, (to - x) / h});
    expected_length += columns * step * std::hypot(1.0, bent.gradient(x));
    expected_above += columns * step * ((last_row + 0.5) * h - bent.height(x));
  }
  EXPECT_NEAR(length / expected_length, 1.0, 1e-6);
  EXPECT_NEAR(above / expected_above, 1.0, 1e-6);
}

TEST(LinearFraction, OfANodeIsTheIntegralOfItsShapeFunction) {
  constexpr double h = 2.0, x = 7.0, z = 15.0;
  constexpr int parts = 2000;
  double length = 0.0, above = 0.0;
  const auto linear = [&](double q) { return std::max(0.0, 1.0 - std::abs(q) / h); };
  for (int i = 0; i < parts; ++i) {
    const double u = x - h + (i + 0.5) * 2.0 * h / parts;
    length += 2.0 * h / parts * std::hypot(1.0, bent.gradient(u)) * linear(u - x) * linear(bent.height(u) - z);
    for (int j = 0; j < parts; ++j) {
      const double w = z - h + (j + 0.5) * 2.0 * h / parts;
      above += w > bent.height(u) ? std::pow(2.0 * h / parts, 2) * linear(u - x) * linear(w - z) : 0.0;
    }
  }
  const auto fraction = bent.linear_fraction(x, z, h);
  EXPECT_NEAR(fraction.length, length, 1e-5);
  EXPECT_NEAR(fraction.above, above, 1e-4);
}

TEST(LinearFraction, OnAGridLineIsTheFaceOfTheCell) {
  const Polyline flat({0.0, 100.0}, {4.0, 4.0});
  EXPECT_DOUBLE_EQ(flat.linear_fraction(10.0, 4.0, 2.0).length, 2.0);
  EXPECT_DOUBLE_EQ(flat.linear_fraction(10.0, 4.0, 2.0).above, 2.0);
  EXPECT_DOUBLE_EQ(flat.linear_fraction(10.0, 6.0, 2.0).length, 0.0);
  EXPECT_DOUBLE_EQ(flat.linear_fraction(10.0, 6.0, 2.0).above, 4.0);
  EXPECT_DOUBLE_EQ(flat.linear_fraction(10.0, 2.0, 2.0).above, 0.0);
}

// For a node above the middle of a notch, both of its sides contribute equally: their load is 1/sin(a) of their vector
// sum, with half the opening angle a.
TEST(LinearFraction, OfANotchIsThatOfAWedge) {
  for (const double half_opening : {0.3, 0.7, 1.2}) {
    const double rise = 1.0 / std::tan(half_opening);
    const ProfileSurface<2> notch(Polyline({0.0, 10.0, 20.0}, {10.0 * rise, 0.0, 10.0 * rise}));
    for (const double z : {-0.3, 0.0, 0.8}) {
      const auto node = notch.at_node(Vector<double, 2>(10.0, z), 2.0);
      EXPECT_NEAR(node.bend, 1.0 / std::sin(half_opening), 1e-12);
      EXPECT_NEAR((node.normal - Vector<double, 2>(0.0, -1.0)).norm(), 0.0, 1e-12);
      EXPECT_LT(node.plane, 0.0);  // the mean height of the node's ground is above its lowest point
      EXPECT_GT(node.plane, -z - 2.0);
    }
  }
}

TEST(RigidPoints, AlongAGridLineAreTheSignedDistance) {
  const Polyline line({0.0, 100.0}, {4.0, 4.0});
  const ProfileSurface<2> smooth(line), points(line, 1.0, 2);
  for (const double z : {4.0, 6.0}) {
    const auto known = smooth.at_node(Vector<double, 2>(10.0, z), 2.0);
    const auto seen = points.at_node(Vector<double, 2>(10.0, z), 2.0);
    EXPECT_EQ(seen.candidate, known.candidate);
    EXPECT_DOUBLE_EQ(seen.area, known.area);
    EXPECT_DOUBLE_EQ(seen.space, known.space);
    EXPECT_NEAR((seen.normal - known.normal).norm(), 0.0, 1e-12);
  }
}

// On a slope the points resolve the surface to within their spacing: the sum of Nairn's area is several percent too
// large, and the normals of nodes with as much rock as space are within 0.2 rad.
TEST(RigidPoints, OnASlopeAreCloseToIt) {
  const double slope = std::tan(0.5);
  const Polyline line({0.0, 400.0}, {200.0, 200.0 - 400.0 * slope});
  const ProfileSurface<2> points(line, 1.0, 20);
  const double h = 2.0;
  double area = 0.0;
  for (int i = 20; i < 120; ++i) {
    for (int j = 0; j < 120; ++j) {
      const Vector<double, 2> position(i * h, j * h);
      const double above = position[1] - line.height(position[0]);
      if (above < -2.0 * h) {
        continue;  // below the layers, which no slide reaches
      }
      const auto seen = points.at_node(position, h);
      area += seen.area;
      if (seen.candidate && seen.space > 0.3 * h * h && seen.space < 0.7 * h * h) {
        EXPECT_LT(std::acos(std::min(1.0, -seen.normal.dot(Vector<double, 2>(std::sin(0.5), std::cos(0.5))))), 0.2);
      }
    }
  }
  EXPECT_GT(area / (200.0 / std::cos(0.5)), 1.0);
  EXPECT_LT(area / (200.0 / std::cos(0.5)), 1.12);
}

}  // namespace
}  // namespace thawslide::terrain
