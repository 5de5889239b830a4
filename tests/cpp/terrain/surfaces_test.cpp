// Ground of a DEM and of a profile: heights, means over columns of nodes, and known areas.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/small_terrain.hpp"
#include "terrain/height_field.hpp"
#include "terrain/polyline.hpp"

namespace thawslide::terrain {
namespace {

const Polyline bent({0.0, 7.3, 11.1, 30.0}, {20.0, 14.6, 9.0, 8.5});

TEST(Polyline, IsExtrapolatedWithTheGradientOfItsEnds) {
  EXPECT_DOUBLE_EQ(bent.height(-7.3), 25.4);
  EXPECT_NEAR(bent.height(48.9), 8.0, 1e-12);
}

TEST(Polyline, MeansOfColumnsAreWeightedByTheHatFunction) {
  constexpr double cell = 5.0;
  constexpr int parts = 100000;
  for (const double at : {-2.0, 7.0, 10.5, 29.0}) {
    double height = 0.0, length = 0.0;
    for (int k = 0; k < parts; ++k) {
      const double from_column = cell * (2.0 * (k + 0.5) / parts - 1.0);
      const double hat = 2.0 * (1.0 - std::abs(from_column) / cell) / parts;
      height += hat * bent.height(at + from_column);
      length += hat * std::hypot(1.0, bent.gradient(at + from_column));
    }
    const Polyline::HatMeans means = bent.hat_means(at, cell);
    EXPECT_NEAR(means.height, height, 1e-5);
    EXPECT_NEAR(means.length, length, 1e-5);
  }
}

using namespace testing_support;

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

// Sums over a fine lattice of places.
TEST(HeightField, MeansOfColumnsAreWeightedByTheHatFunction) {
  const HeightField ground(rough_raster());
  constexpr double cell = 7.0;
  constexpr int parts = 700;
  for (const Place& at : {Place(13.0, 21.2), Place(40.1, 30.0), Place(-19.0, 64.0)}) {
    double height = 0.0, area = 0.0;
    for (int j = 0; j < parts; ++j) {
      for (int i = 0; i < parts; ++i) {
        const Place from_column = cell * (2.0 * Place(i + 0.5, j + 0.5) / parts - Place(1.0, 1.0));
        const double hat = (1.0 - std::abs(from_column[0]) / cell) * (1.0 - std::abs(from_column[1]) / cell);
        height += 4.0 * hat / (parts * parts) * ground.height(at + from_column);
        area += 4.0 * hat / (parts * parts) * std::hypot(1.0, ground.gradient(at + from_column, 0.0).norm());
      }
    }
    const auto means = ground.column_means(at, cell);
    EXPECT_NEAR(means.height, height, 1e-3);
    EXPECT_NEAR(means.area, area, 1e-3);
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
