// The ground from a DEM: heights, distances, known areas, and replacement of missing points.
#include "terrain/height_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "../support/small_terrain.hpp"
#include "terrain/nearest_on_triangle.hpp"

namespace thawslide::terrain {
namespace {

using namespace testing_support;

TEST(HeightField, DistanceIsThatOfTheNearestTriangle) {
  Raster points = rough_raster();
  points.cell_y = 6.0;
  const HeightField ground(points);
  const auto all = triangles(points);
  for (const double h : {1.7, 5.0, 12.0}) {
    for (const double z : {-14.0, 2.0, 14.0}) {
      const Position lowest(10.3, 17.1, z);
      const auto nodes = block_at(ground, lowest, h);
      for (int k = 0; k < edge * edge * edge; ++k) {
        const Position place = lowest + h * Position(k % edge, k / edge % edge, k / edge / edge);
        if (std::max(std::abs(place[0] - 30.0), std::abs(place[1] - 25.0)) > 25.0) {
          continue;  // closer to the edge of the points than to the ground
        }
        double least = HUGE_VAL;
        for (const auto& triangle : all) {
          least = std::min(least, (nearest_on_triangle(place, triangle) - place).norm());
        }
        const double sign = place[2] > ground.height(place.head<2>()) ? 1.0 : -1.0;
        const Node& node = nodes[static_cast<std::size_t>(k)];
        EXPECT_NEAR(node.distance, sign * std::min(least, 4.0 * h), 1e-12) << place.transpose();
        EXPECT_NEAR(node.normal.norm(), 1.0, 1e-12);
        if (node.area == 0.0 && least < 4.0 * h) {
          const Position foot = place + node.distance * node.normal;
          EXPECT_NEAR(foot[2], ground.height(foot.head<2>()), 1e-11);
        }
      }
    }
  }
}

TEST(NearestOnTriangle, IsAtMostAsFarAsAnyOfItsPoints) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const auto position = [&] { return Position(number(random), number(random), number(random)); };
  for (int trial = 0; trial < 200; ++trial) {
    const std::array<Position, 3> triangle{position(), position(), position()};
    const Position place = 2.0 * position();
    double least = HUGE_VAL;
    constexpr int parts = 200;
    for (int i = 0; i <= parts; ++i) {
      for (int j = 0; i + j <= parts; ++j) {
        const Position there = (i * triangle[0] + j * triangle[1] + (parts - i - j) * triangle[2]) / parts;
        least = std::min(least, (there - place).norm());
      }
    }
    const double distance = (nearest_on_triangle(place, triangle) - place).norm();
    EXPECT_LE(distance, least + 1e-12);
    EXPECT_GT(distance, least - 0.02);
  }
}

TEST(HeightField, HighestIsTheTopOfTheRectangle) {
  const Raster points = rough_raster();
  const HeightField ground(points);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> x(-30.0, 90.0), y(-25.0, 75.0), size(0.0, 1.0);
  for (int trial = 0; trial < 60; ++trial) {
    const Place from(x(random), y(random));
    const Place to = from + std::pow(size(random), 3) * Place(60.0, 50.0);
    double sampled = -HUGE_VAL;
    constexpr int parts = 200;
    for (int k = 0; k <= parts; ++k) {
      for (int i = 0; i <= parts; ++i) {
        sampled = std::max(sampled, ground.height(from + (to - from).cwiseProduct(Place(i, k)) / parts));
      }
    }
    const double top = ground.highest(from, to);
    EXPECT_GE(top, sampled - 1e-12);
    EXPECT_LT(top, sampled + 0.01 * (to - from).lpNorm<1>() + 1e-12);
  }
  EXPECT_EQ(ground.highest({-100.0, -100.0}, {300.0, 300.0}),
            *std::max_element(points.values.begin(), points.values.end()));
}

TEST(HeightField, IsExtrapolatedWithTheHeightOfItsEdge) {
  const Raster points = rough_raster();
  const HeightField ground(points);
  EXPECT_DOUBLE_EQ(ground.height({-500.0, 3.0}), ground.height({-20.0, 3.0}));
  EXPECT_DOUBLE_EQ(ground.height({11.0, 900.0}), ground.height({11.0, points.y_end()}));
  EXPECT_DOUBLE_EQ(ground.height({1e4, 1e4}), points.at(20, 16));
  EXPECT_EQ(ground.gradient({-500.0, 3.0}, 0.0)[0], 0.0);
  EXPECT_EQ(ground.gradient({1e4, 1e4}, 0.0).norm(), 0.0);
  const double slope = (points.at(0, 4) - points.at(0, 3)) / 5.0;
  EXPECT_NEAR(ground.gradient({-500.0, 3.0}, 0.0)[1], slope, 1e-12);
  const Node node = node_at(ground, {-60.0, 2.5, ground.height({-60.0, 2.5})}, 2.0);
  EXPECT_NEAR(node.distance, 0.0, 1e-12);
  EXPECT_NEAR((node.normal - Position(0.0, slope, -1.0).normalized()).norm(), 0.0, 1e-12);
}

// By the divergence theorem, the mean gradient is the height difference between opposite sides over the width.
TEST(HeightField, GradientOverAWidthIsTheMean) {
  const HeightField ground(rough_raster());
  for (const double width : {0.3, 4.0, 17.0}) {
    for (const Place& place : {Place(13.0, 21.2), Place(40.1, 30.0), Place(-19.0, 64.0)}) {
      constexpr int parts = 20000;
      Place gain = Place::Zero();
      for (int k = 0; k < parts; ++k) {
        const double along = width * ((k + 0.5) / parts - 0.5);
        gain[0] += ground.height(place + Place(0.5 * width, along)) - ground.height(place + Place(-0.5 * width, along));
        gain[1] += ground.height(place + Place(along, 0.5 * width)) - ground.height(place + Place(along, -0.5 * width));
      }
      EXPECT_NEAR((ground.gradient(place, width) - gain / (parts * width)).norm(), 0.0, 1e-7);
    }
  }
}

TEST(HeightField, BlocksFarFromTheSurfaceAreOpenOrSolid) {
  const HeightField ground(rough_raster());
  for (const Node& node : block_at(ground, {10.0, 10.0, 500.0}, 5.0)) {
    EXPECT_FALSE(node.candidate);
    EXPECT_EQ(node.area, 0.0);
    EXPECT_EQ(node.space, 125.0);
    EXPECT_EQ(node.distance, 20.0);
    EXPECT_NEAR(node.normal.norm(), 1.0, 1e-12);
  }
  for (const Node& node : block_at(ground, {10.0, 10.0, -500.0}, 5.0)) {
    EXPECT_TRUE(node.candidate);
    EXPECT_EQ(node.area, 0.0);
    EXPECT_EQ(node.space, 0.0);
    EXPECT_EQ(node.distance, -20.0);
  }
}

TEST(HeightField, IsKnownIfAllPointsOfACellHaveData) {
  Raster points = rough_raster();
  points.values[points.index(10, 8)] = no_data;
  const HeightField ground(points);
  const Place hole(points.x_of(10), points.y_of(8));
  EXPECT_TRUE(ground.is_known(hole + Place(5.1, 0.0)));
  EXPECT_FALSE(ground.is_known(hole + Place(4.9, 0.0)));
  EXPECT_FALSE(ground.is_known(hole + Place(-4.9, -4.9)));
  EXPECT_TRUE(ground.is_known(hole + Place(-5.1, -4.9)));
  EXPECT_TRUE(ground.is_known(hole + Place(5.0, -20.0), hole + Place(20.0, 20.0)));
  EXPECT_FALSE(ground.is_known(hole + Place(4.9, -20.0), hole + Place(20.0, 20.0)));
  EXPECT_TRUE(ground.is_known({points.x, points.y}, {points.x_end(), hole[1] - 5.0}));
  EXPECT_FALSE(ground.is_known({points.x, points.y}, {points.x_end(), points.y_end()}));
  EXPECT_TRUE(ground.is_known({points.x_end(), points.y_end()}));
  EXPECT_FALSE(ground.is_known({points.x_end() + 0.1, points.y}));
  EXPECT_FALSE(ground.is_known({points.x - 0.1, points.y}, {points.x + 5.0, points.y + 5.0}));
  EXPECT_TRUE(HeightField(rough_raster()).is_known({points.x, points.y}, {points.x_end(), points.y_end()}));
}

}  // namespace
}  // namespace thawslide::terrain
