// The limit of slopes lowers crests of the ground of cells that follow the terrain, and nothing else.
#include "terrain/following_ground.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "../support/small_terrain.hpp"
#include "terrain/height_field.hpp"
#include "terrain/polyline.hpp"

namespace thawslide::terrain {
namespace {

using namespace testing_support;

constexpr double cell = 5.0, extent = 200.0;
constexpr int columns = 41;  // along each axis
const double limit = std::tan(65.0 * pi / 180.0);

// Wall of 80 degrees and 60 m, oblique to the grid, with a bend; gentle waves on both sides.
double wall(double x, double y) {
  const double across = 0.8 * x + 0.6 * std::abs(y - 80.0) - 100.0;
  return std::clamp(across * std::tan(80.0 * pi / 180.0), 0.0, 60.0) + 3.0 * std::sin(0.1 * x) * std::cos(0.08 * y);
}

std::shared_ptr<const HeightField> dem(const std::function<double(double, double)>& height) {
  return std::make_shared<HeightField>(raster(-30.0, -30.0, 2.5, 105, 105, height));
}

FollowingGround<3> ground_on(const std::shared_ptr<const HeightField>& terrain, double steepest) {
  mpm::BodySizes sizes;
  sizes.add(0.25);
  return {terrain, cell, Place(extent, extent), sizes, mpm::SectionWidth(), steepest};
}

// Heights of the columns in the domain, x fastest, from blocks of nodes.
std::vector<double> column_heights(const FollowingGround<3>& ground) {
  constexpr int edge = 4;
  std::vector<double> heights(columns * columns);
  std::vector<GroundAtNode<3>> nodes(edge * edge * edge);
  for (int j = 0; j < columns; j += edge) {
    for (int i = 0; i < columns; i += edge) {
      ground.at_block({i, j, 0}, edge, nodes.data());
      for (int b = 0; b < std::min(edge, columns - j); ++b) {
        for (int a = 0; a < std::min(edge, columns - i); ++a) {
          heights[static_cast<std::size_t>(i + a + (j + b) * columns)] =
              nodes[static_cast<std::size_t>(a + edge * b)].elevation;
        }
      }
    }
  }
  return heights;
}

// Along the axes and the diagonals.
double path_length(int i, int j) {
  const int longer = std::max(std::abs(i), std::abs(j)), shorter = std::min(std::abs(i), std::abs(j));
  return cell * (longer - shorter + std::sqrt(2.0) * shorter);
}

TEST(SlopeLimit, LowersColumnsToTheLowestConeThatBeginsAtAnother) {
  const auto terrain = dem(wall);
  const FollowingGround<3> ground = ground_on(terrain, limit);
  const std::vector<double> heights = column_heights(ground), before = column_heights(ground_on(terrain, HUGE_VAL));
  std::size_t lowered = 0, at_the_foot = 0;
  double largest = 0.0;
  Place place;
  for (int j = 0; j < columns; ++j) {
    for (int i = 0; i < columns; ++i) {
      const auto here = static_cast<std::size_t>(i + j * columns);
      double expected = HUGE_VAL;
      for (int m = 0; m < columns; ++m) {
        for (int n = 0; n < columns; ++n) {
          expected =
              std::min(expected, before[static_cast<std::size_t>(n + m * columns)] + limit * path_length(n - i, m - j));
        }
      }
      EXPECT_NEAR(heights[here], expected, 1e-6) << i << " " << j;
      const double change = before[here] - heights[here];
      lowered += change > 0.0 ? 1 : 0;
      if (change > largest) {
        largest = change;
        place = cell * Place(i, j);
      }
      if (wall(cell * i, cell * j) < 3.0) {
        EXPECT_EQ(change, 0.0) << "a foot is not changed";
        ++at_the_foot;
      }
    }
  }
  EXPECT_GT(lowered, 30U);
  EXPECT_LT(lowered, columns * columns / 4U);
  EXPECT_GT(at_the_foot, columns * columns / 4U);
  EXPECT_EQ(ground.lowering().columns, lowered);
  EXPECT_NEAR(ground.lowering().largest, largest, 1e-6);
  EXPECT_EQ(ground.lowering().place, place);
}

TEST(SlopeLimit, LeavesGentlerTerrainAlone) {
  const auto plane = dem([](double x, double y) { return 1.2 * x - 1.5 * y; });  // 62.5 degrees
  const FollowingGround<3> ground = ground_on(plane, limit);
  EXPECT_EQ(ground.lowering().columns, 0U);
  EXPECT_EQ(column_heights(ground), column_heights(ground_on(plane, HUGE_VAL)));
}

TEST(SlopeLimit, CutsBackThePlateauAboveAProfilesWall) {
  const auto profile =
      std::make_shared<ProfileSurface<2>>(Polyline({0.0, 100.0, 100.1, 300.0}, {0.0, 0.0, 60.0, 60.0}));
  mpm::BodySizes sizes;
  sizes.add(0.25);
  const FollowingGround<2> ground(profile, cell, Vector<double, 1>(300.0), sizes, mpm::SectionWidth(), limit);
  const double length = 60.0 / limit;  // of the wall, which begins a cell before that of the terrain
  EXPECT_EQ(ground.height(Vector<double, 1>(90.0)), 0.0);
  EXPECT_NEAR(ground.height(Vector<double, 1>(110.0)), 15.0 * limit, 1e-9);
  EXPECT_NEAR(ground.height(Vector<double, 1>(100.0 + length + 2.0 * cell)), 60.0, 1e-9);
  EXPECT_NEAR(static_cast<double>(ground.lowering().columns), length / cell, 1.0);
  EXPECT_GT(ground.lowering().largest, 30.0);
}

}  // namespace
}  // namespace thawslide::terrain
