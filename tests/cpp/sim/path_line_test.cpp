// Lines along which the travel distance is measured, and the front.
#include "sim/maps/path_line.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/records/run_records.hpp"

namespace thawslide::sim {
namespace {

// East for 30 m, then north for 40 m.
PathLine angled() { return PathLine({{10.0, 5.0}, {10.0, 5.0}, {40.0, 5.0}, {40.0, 45.0}}); }

TEST(PathLine, MeasuresItsLength) {
  EXPECT_EQ(angled().length(), 70.0);
  EXPECT_EQ(angled().corners().size(), 3u);
  EXPECT_TRUE(PathLine().empty());
  EXPECT_TRUE(PathLine({{1.0, 1.0}, {1.0, 1.0}}).empty());
}

TEST(PathLine, ProjectsToTheNearestPoint) {
  const PathLine line = angled();
  const auto expect = [&](const Point2& position, double along, double offset) {
    const LinePosition found = line.project(position);
    EXPECT_NEAR(found.along, along, 1e-12) << position[0] << " " << position[1];
    EXPECT_NEAR(found.offset, offset, 1e-12) << position[0] << " " << position[1];
  };
  expect({20.0, 8.0}, 10.0, 3.0);
  expect({20.0, 1.0}, 10.0, -4.0);
  expect({43.0, 25.0}, 50.0, -3.0);
  expect({38.0, 25.0}, 50.0, 2.0);
  expect({43.0, 1.0}, 30.0, -5.0);  // outside the bend: the corner
  expect({4.0, 6.0}, -6.0, 1.0);    // straight on before its beginning
  expect({39.0, 60.0}, 85.0, 1.0);  // and beyond its end
}

TEST(PathLine, PointsOnTheLineProjectToThemselves) {
  const PathLine line = angled();
  for (const double along : {-7.0, 0.0, 12.5, 30.0, 55.0, 70.0, 100.0}) {
    EXPECT_NEAR(line.project(line.point_at(along)).along, along, 1e-12);
    EXPECT_NEAR(line.project(line.point_at(along)).offset, 0.0, 1e-12);
  }
}

// Compared with all points of a long winding line, one by one.
TEST(PathLine, ProjectsOntoManySegments) {
  PathLine line;
  for (int k = 0; k < 100; ++k) {
    line.add({3.0 * k, 40.0 * std::sin(0.1 * k)});
  }
  line.add({0.0, 500.0});
  line.remove_last();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> east(0.0, 297.0), north(-80.0, 80.0);
  for (int n = 0; n < 200; ++n) {
    const Point2 position{east(random), north(random)};
    const LinePosition found = line.project(position);
    const auto distance_at = [&](double along) {
      const Point2 point = line.point_at(along);
      return std::hypot(position[0] - point[0], position[1] - point[1]);
    };
    EXPECT_NEAR(distance_at(found.along), std::abs(found.offset), 1e-9);
    for (double along = 0.0; along <= line.length(); along += 0.5) {
      ASSERT_GE(distance_at(along), std::abs(found.offset) - 1e-9) << position[0] << " " << position[1];
    }
  }
}

TEST(CentrePath, HasCornersOneSpacingApart) {
  CentrePath path(2.0);
  for (int k = 0; k <= 100; ++k) {
    const double wavering = 0.01 * (k % 2);
    path.add_position({0.1 * k, wavering});
    EXPECT_EQ(path.line().empty(), k == 0);
    EXPECT_EQ(path.line().corners().size(), k == 0 ? 1u : k < 40 ? 2u : static_cast<std::size_t>(k / 20 + 1)) << k;
    if (k > 0 && k < 20) {
      EXPECT_EQ(path.line().corners().back(), (Point2{0.1 * k, wavering}));
    }
  }
  EXPECT_NEAR(path.line().length(), 10.0, 1e-3);
}

TEST(CentrePath, HasNoDirectionBeforeTheCentreMoves) {
  CentrePath path(2.0);
  path.add_position({5.0, 5.0});
  path.add_position({5.0, 5.019});
  EXPECT_TRUE(path.line().empty());
  path.add_position({5.021, 5.0});
  EXPECT_FALSE(path.line().empty());
  EXPECT_NEAR(path.line().project({8.0, 4.0}).along, 3.0, 1e-12);
  path.add_position({5.0, 5.0});
  EXPECT_TRUE(path.line().empty());
}

TEST(CentrePath, ContinuesFromItsState) {
  for (const int stop : {0, 1, 7, 19, 20, 21, 60}) {
    CentrePath whole(2.0), first(2.0);
    for (int k = 0; k <= stop; ++k) {
      first.add_position({0.1 * k, 0.02 * k});
    }
    CentrePath second(2.0);
    second.restore(first.state());
    for (int k = 0; k <= 80; ++k) {
      whole.add_position({0.1 * k, 0.02 * k});
      if (k > stop) {
        second.add_position({0.1 * k, 0.02 * k});
      }
    }
    EXPECT_EQ(second.state(), whole.state()) << stop;
  }
}

TEST(RunFigures, AngleOfReachIsTheSlopeFromTopToFront) {
  EXPECT_NEAR(angle_of_reach(100.0, 100.0), 45.0, 1e-12);
  EXPECT_NEAR(angle_of_reach(500.0, 500.0 * std::sqrt(3.0)), 30.0, 1e-12);
  EXPECT_EQ(angle_of_reach(0.0, 10.0), 0.0);
  EXPECT_TRUE(std::isnan(angle_of_reach(10.0, 0.0)));
}

TEST(RunFigures, AreReportedByNameAndUnit) {
  const auto figures = named({1.0, 2.0, 7.0, 8.0, 9.0, 3.0, 4.0, 5.0, 6.0});
  const std::vector<std::pair<std::string, double>> expected{
      {"covered_volume_m3", 1.0}, {"covered_area_m2", 2.0},   {"affected_area_m2", 7.0},
      {"deposit_area_m2", 8.0},   {"inundated_area_m2", 9.0}, {"front_distance_m", 3.0},
      {"travel_distance_m", 4.0}, {"drop_height_m", 5.0},     {"reach_angle_degrees", 6.0}};
  EXPECT_EQ(figures, expected);
}

}  // namespace
}  // namespace thawslide::sim
