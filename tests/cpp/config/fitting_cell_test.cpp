// Proposed cell sizes divide the domain along each axis and respect their lower or upper bound.
#include "config/fitting_cell.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thawslide::config {
namespace {

using Lengths = std::vector<double>;

bool fits(double cell, const Lengths& lengths) {
  bool all = true;
  for (const double length : lengths) {
    const double cells = length / cell;
    all = all && cells > 1.999 && std::abs(cells - std::round(cells)) < 1e-6 * cells;  // as in check_grid
  }
  return all;
}

TEST(FittingCell, NearAGivenSizeFitsAllAxes) {
  const Lengths valley{9960.0, 4320.0, 1800.0};
  EXPECT_EQ(fitting_cell_near(80.0, valley), 60.0);
  EXPECT_EQ(fitting_cell_near(79.68, valley), 60.0) << "not 80 m again";
  EXPECT_EQ(fitting_cell_near(35.0, valley), 40.0);
  EXPECT_EQ(fitting_cell_near(8.0, {100.0, 60.0}), 10.0);
  EXPECT_EQ(fitting_cell_near(0.8, {10.0, 6.0}), 1.0);
}

TEST(FittingCell, NearAnySizeFitsOrIsZero) {
  int found = 0;
  for (int k = 1; k < 2000; ++k) {
    const Lengths lengths{0.1 * (200 + k % 37), 0.1 * (150 + k % 11), 12.5};
    const double requested = 0.01 * k, cell = fitting_cell_near(requested, lengths);
    found += cell > 0.0 ? 1 : 0;
    EXPECT_TRUE(cell == 0.0 || (fits(cell, lengths) && cell < 1.51 * requested && requested < 1.51 * cell))
        << cell << " m for " << requested << " m";
  }
  EXPECT_GT(found, 10);
}

TEST(FittingCell, IsZeroIfTheLengthsHaveNoCommonDivisor) {
  EXPECT_EQ(fitting_cell_near(5.0, {101.0, 60.0}), 0.0) << "1 m is far off";
  EXPECT_EQ(fitting_cell_near(5.0, {100.0 / 3.0, 60.0}), 0.0);
  EXPECT_EQ(fitting_cell_near(5.0, {100.0, -60.0}), 0.0);
  EXPECT_EQ(fitting_cell_near(5.0, {7.0, 7.0}), 3.5) << "two cells at least, not the one of 7 m";
}

TEST(FittingCell, RespectsItsLowerOrUpperBound) {
  const Lengths lengths{200.0, 60.0};
  EXPECT_DOUBLE_EQ(fitting_cell(1.9, 2.0, lengths), 20.0 / 11.0) << "20 m is the greatest length that divides both";
  EXPECT_EQ(fitting_cell(1.3, 2.0, lengths), 1.0) << "few digits preferred";
  EXPECT_EQ(fitting_cell_from(2.1, 2.0, lengths), 2.5);
  EXPECT_EQ(fitting_cell_from(30.0, 2.0, lengths), 30.0) << "no size fits, and the required one is returned";
  EXPECT_EQ(fitting_cell(1.9, 2.0, {}), 1.5);
}

}  // namespace
}  // namespace thawslide::config
