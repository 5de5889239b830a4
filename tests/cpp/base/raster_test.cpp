// Values between the points of a raster, at points without data, and the volume of a thickness.
#include "base/raster.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "../support/small_terrain.hpp"

namespace thawslide {
namespace {

using testing_support::no_data;
using testing_support::raster;

double plane(double x, double y) { return 100.0 + 0.3 * x - 0.7 * y; }

Raster plane_raster() { return raster(0.0, 0.0, 5.0, 5, 4, plane); }

TEST(Bilinear, IsExactOnAPlaneUpToTheOutermostPoints) {
  const Raster raster = plane_raster();
  for (const Missing missing : {Missing::unknown, Missing::nothing, Missing::zero}) {
    EXPECT_NEAR(bilinear(raster, 7.3, 11.9, missing), plane(7.3, 11.9), 1e-12);
    EXPECT_EQ(bilinear(raster, 20.0, 15.0, missing), raster.at(4, 3));
    EXPECT_NEAR(bilinear(raster, 20.0 + 1e-12, -1e-12, missing), raster.at(4, 0), 1e-9);
  }
  EXPECT_TRUE(std::isnan(bilinear(raster, 20.1, 15.0, Missing::unknown)));
  EXPECT_TRUE(std::isnan(bilinear(raster, 20.1, 15.0, Missing::nothing)));
  EXPECT_NEAR(bilinear(raster, 21.25, 15.0, Missing::zero), 0.75 * raster.at(4, 3), 1e-12);
  EXPECT_EQ(bilinear(raster, 25.0, 15.0, Missing::zero), 0.0);
}

TEST(Bilinear, IgnoresAPointWithoutData) {
  Raster raster = plane_raster();
  raster.values[raster.index(1, 1)] = no_data;
  EXPECT_TRUE(std::isnan(bilinear(raster, 7.5, 5.0, Missing::unknown)));
  EXPECT_EQ(bilinear(raster, 10.0, 5.0, Missing::unknown), raster.at(2, 1));
  EXPECT_EQ(bilinear(raster, 7.5, 5.0, Missing::nothing), raster.at(2, 1));
  EXPECT_EQ(bilinear(raster, 7.5, 5.0, Missing::zero), 0.5 * raster.at(2, 1));
  EXPECT_TRUE(std::isnan(bilinear(raster, 5.0, 5.0, Missing::nothing)));
  EXPECT_EQ(bilinear(raster, 5.0, 5.0, Missing::zero), 0.0);
}

TEST(Bilinear, AThicknessKeepsItsVolumeOnFinerPoints) {
  Raster thickness = plane_raster();
  thickness.values[thickness.index(1, 1)] = no_data;
  double sum = 0.0;
  for (double y = -4.5; y < 20.0; y += 1.0) {
    for (double x = -4.5; x < 25.0; x += 1.0) {
      sum += bilinear(thickness, x, y, Missing::zero);
    }
  }
  EXPECT_NEAR(sum / volume_of(thickness), 1.0, 1e-12);
}

TEST(FillFromNearestKnown, UsesTheNearestPoint) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> number(0.0, 1.0);
  Raster points =
      raster(0.0, 0.0, 5.0, 31, 23, [&](double, double) { return number(random) > 0.93 ? number(random) : no_data; });
  points.cell_y = 3.0;
  Raster filled = points;
  fill_from_nearest_known(filled);
  for (int row = 0; row < points.rows; ++row) {
    for (int column = 0; column < points.columns; ++column) {
      double least = HUGE_VAL, of_taken = HUGE_VAL;
      for (int j = 0; j < points.rows; ++j) {
        for (int i = 0; i < points.columns; ++i) {
          const double squared = std::pow(5.0 * (i - column), 2) + std::pow(3.0 * (j - row), 2);
          if (!std::isnan(points.at(i, j))) {
            least = std::min(least, squared);
            of_taken = points.at(i, j) == filled.at(column, row) ? std::min(of_taken, squared) : of_taken;
          }
        }
      }
      EXPECT_EQ(of_taken, least);
    }
  }
}

}  // namespace
}  // namespace thawslide
