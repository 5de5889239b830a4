// Resampled points, tapers and values between points.
#include <numeric>

#include "gis/point_window.hpp"
#include "gis/release.hpp"
#include "gis/sampling.hpp"
#include "map_files.hpp"

namespace thawslide::gis {
namespace {

using namespace map_files;

double plane(double x, double y) { return 2000.0 + 0.3 * x - 0.7 * y; }

TEST(ResamplingTest, PlanesStayPlanes) {
  Raster raster = raster_of(plane, 0.0, 0.0, 4.9977, 41, 37);
  for (const double distance : {2.0, 4.9977, 7.5, 20.0}) {
    const Raster layout = resampled_layout(raster, distance);
    const Raster made = resampled(raster, layout);
    ASSERT_GT(made.values.size(), 10U);
    EXPECT_GE(made.x, raster.x);
    EXPECT_LE(made.x_end(), raster.x_end() + 1e-9);
    EXPECT_GT(made.x_end(), raster.x_end() - 1.5 * distance);
    for_points(made, [&](int column, int row) {
      EXPECT_NEAR(made.at(column, row), plane(made.x_of(column), made.y_of(row)), 1e-9) << distance;
    });
  }
}

TEST(ResamplingTest, SameSpacingKeepsEveryBit) {
  const Raster raster = raster_of([](double x, double y) { return std::sin(x) * y; }, 3.0, 4.0, 5.0, 12, 9);
  EXPECT_EQ(resampled(raster, resampled_layout(raster, 5.0)).values, raster.values);
}

// Half the spacing: the mean of two and of four neighbours. Twice the spacing: weights 1/8, 3/8, 3/8, 1/8 along an axis
// about a position half-way between points.
TEST(ResamplingTest, WeightsAreThoseOfTheFormulas) {
  const Raster raster =
      raster_of([](double x, double y) { return x == 2.0 && y == 2.0 ? 64.0 : 0.0; }, 0.0, 0.0, 1.0, 6, 6);
  const Raster fine = resampled(raster, resampled_layout(raster, 0.5));
  EXPECT_EQ(fine.at(4, 4), 64.0);
  EXPECT_EQ(fine.at(5, 4), 32.0);
  EXPECT_EQ(fine.at(5, 5), 16.0);
  EXPECT_EQ(fine.at(6, 4), 0.0);
  const Raster layout = resampled_layout(raster, 2.0);
  EXPECT_EQ(layout.x, 1.0);
  const Raster coarse = resampled(raster, layout);
  EXPECT_EQ(coarse.columns, 2);
  // Points at 1 and 3: the mean over 0 .. 2 of the linear shape function at 2 is 1/4; so is that over 2 .. 4.
  EXPECT_NEAR(coarse.at(0, 0), 4.0, 1e-12);
  EXPECT_NEAR(coarse.at(1, 1), 4.0, 1e-12);
}

TEST(ResamplingTest, HolesRemainAndDoNotGrow) {
  Raster raster = raster_of(plane, 0.0, 0.0, 1.0, 9, 9);
  raster.values[raster.index(4, 4)] = missing;
  const Raster fine = resampled(raster, resampled_layout(raster, 0.5));
  EXPECT_TRUE(std::isnan(fine.at(8, 8)));
  EXPECT_TRUE(std::isnan(fine.at(7, 8)));
  EXPECT_FALSE(std::isnan(fine.at(6, 8)));
  const Raster coarse = resampled(raster, resampled_layout(raster, 4.0));
  EXPECT_FALSE(std::isnan(coarse.at(0, 0)));
}

TEST(ResamplingTest, TaperKeepsTheVolumeAndReachesHalfItsWidth) {
  const Raster thickness =
      raster_of([](double x, double y) { return std::abs(x) < 31.0 && std::abs(y) < 21.0 ? 10.0 : 0.0; }, -60.0, -60.0,
                2.0, 61, 61);
  const auto volume = [](const Raster& raster) {
    return std::accumulate(raster.values.begin(), raster.values.end(), 0.0);
  };
  const Raster soft = tapered(thickness, 12.0);
  EXPECT_NEAR(volume(soft), volume(thickness), 1e-12 * volume(thickness));
  EXPECT_NEAR(soft.at(30, 30), 10.0, 1e-12);
  // The last point with a thickness is at x = 30, the next at 32: the weights extend over two points on each side.
  EXPECT_EQ(taper_reach(12.0, 2.0), 2);
  EXPECT_GT(soft.at(47, 30), 0.0);
  EXPECT_EQ(soft.at(48, 30), 0.0);
  for (int column = 30; column < 48; ++column) {
    EXPECT_LE(soft.at(column + 1, 30), soft.at(column, 30) + 1e-12);
  }
  EXPECT_EQ(tapered(thickness, 0.0).values, thickness.values);
  EXPECT_EQ(tapered(thickness, 4.0).values, thickness.values);
}

TEST(ResamplingTest, GradientsAndThicknessAlongTheNormal) {
  Raster raster = raster_of(plane, 0.0, 0.0, 5.0, 5, 4);
  for (const auto& [column, row] : {std::pair{2, 2}, std::pair{0, 0}, std::pair{4, 3}}) {
    EXPECT_NEAR(gradient_at(raster, column, row).x, 0.3, 1e-12);
    EXPECT_NEAR(gradient_at(raster, column, row).y, -0.7, 1e-12);
  }
  raster.values[raster.index(3, 2)] = missing;
  EXPECT_NEAR(gradient_at(raster, 2, 2).x, 0.3, 1e-12);
  // A 3-4-5 triangle: a slope whose cosine is 0.8.
  EXPECT_NEAR(vertical_thickness(8.0, 0.75, 0.0), 10.0, 1e-12);
  EXPECT_NEAR(vertical_thickness(8.0, 0.45, -0.6), 10.0, 1e-12);
}

}  // namespace
}  // namespace thawslide::gis
