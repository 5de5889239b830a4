// Values between the points of a raster, at points without data, and the volume of a thickness.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "base/nearest_known.hpp"
#include "base/raster_sampling.hpp"

namespace thawslide {
namespace {

constexpr double no_data = std::numeric_limits<double>::quiet_NaN();

double plane(double x, double y) { return 100.0 + 0.3 * x - 0.7 * y; }

Raster plane_raster() {
  Raster raster;
  raster.cell_x = raster.cell_y = 5.0;
  raster.columns = 5;
  raster.rows = 4;
  for (int row = 0; row < raster.rows; ++row) {
    for (int column = 0; column < raster.columns; ++column) {
      raster.values.push_back(plane(raster.x_of(column), raster.y_of(row)));
    }
  }
  return raster;
}

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
  Raster points;
  points.cell_x = 5.0;
  points.cell_y = 3.0;
  points.columns = 31;
  points.rows = 23;
  for (int k = 0; k < points.columns * points.rows; ++k) {
    const bool known = number(random) > 0.93;
    points.values.push_back(known ? number(random) : no_data);
  }
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
