// The taper that `thawslide new --cut` proposes: wide enough for the sliding mass to leave the excavation, within the
// available space.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/small_terrain.hpp"
#include "config/case_proposal.hpp"

namespace thawslide::config {
namespace {

using testing_support::raster;

constexpr double cell = 10.0;  // of the DEM [m]

// A plane that falls to the east.
Raster plane(double slope) {
  return raster(0.0, 0.0, cell, 80, 60, [=](double x, double) { return 500.0 - slope * x; });
}

// Thickness by the column and row of a point on `columns` x `rows` points, plus one point on each side, as a release is
// read.
Raster release_of(int first_column, int first_row, int columns, int rows,
                  const std::function<double(int, int)>& thickness) {
  const double x0 = (first_column - 1) * cell, y0 = (first_row - 1) * cell;
  return raster(x0, y0, cell, columns + 2, rows + 2, [&](double x, double y) {
    const auto column = static_cast<int>(std::lround((x - x0) / cell));
    const auto row = static_cast<int>(std::lround((y - y0) / cell));
    return column >= 1 && column <= columns && row >= 1 && row <= rows ? thickness(column, row) : 0.0;
  });
}
Raster release(int first_column, int first_row, int columns, int rows, double thickness) {
  return release_of(first_column, first_row, columns, rows, [=](int, int) { return thickness; });
}

TEST(TaperProposal, FallsNoLessThanTheTerrainAndIsThreeThicknessesWide) {
  const EdgeTaper gentle = propose_taper(plane(0.5), release(30, 20, 21, 21, 20.0));
  EXPECT_EQ(gentle.width, 80.0) << "2 x 20 m / 0.5";
  EXPECT_NEAR(gentle.slope, 0.5, 1e-12);
  EXPECT_NEAR(gentle.steepest, 0.5, 1e-12);
  EXPECT_FALSE(gentle.is_cramped());
  EXPECT_EQ(propose_taper(plane(0.8), release(30, 20, 21, 21, 20.0)).width, 60.0) << "3 x 20 m";
  EXPECT_EQ(propose_taper(plane(0.45), release(30, 20, 21, 21, 20.0)).width, 90.0) << "88.9 m in whole cells";
  EXPECT_EQ(propose_taper(plane(0.0), release(30, 20, 25, 25, 20.0)).width, 200.0) << "10 x 20 m";
}

TEST(TaperProposal, IsOmittedIfTheCellsOfTheDemAreAsWide) {
  const EdgeTaper taper = propose_taper(plane(0.8), release(30, 20, 21, 21, 6.0));
  EXPECT_EQ(taper.width, 0.0);
  EXPECT_FALSE(taper.is_cramped());
  EXPECT_NEAR(taper.steepest, 0.6, 1e-12);
}

TEST(TaperProposal, StaysOnKnownGround) {
  const Raster dem = plane(0.5);
  for (const auto& [first_column, width] : {std::pair(3, 60.0), {2, 40.0}, {1, 0.0}, {4, 80.0}}) {
    const EdgeTaper taper = propose_taper(dem, release(first_column, 20, 21, 21, 20.0));
    EXPECT_EQ(taper.width, width) << first_column;
    EXPECT_EQ(taper.is_cramped(), width < 80.0) << first_column;
  }
  // For a hole diagonal to the corner, the distance along the axis with the larger distance counts.
  Raster holed = dem;
  holed.values[holed.index(28, 16)] = std::nan("");
  EXPECT_EQ(propose_taper(holed, release(30, 20, 21, 21, 20.0)).width, 60.0);
  // A hole within the bounding rectangle of the release, but away from its points.
  const Raster angled =
      release_of(30, 20, 31, 31, [](int column, int row) { return column >= 12 && row >= 12 ? 0.0 : 20.0; });
  Raster far = dem;
  far.values[far.index(55, 45)] = std::nan("");
  EXPECT_EQ(propose_taper(far, angled).width, 80.0);
}

TEST(TaperProposal, KeepsTheThicknessInTheMiddle) {
  const EdgeTaper taper = propose_taper(plane(0.5), release(30, 20, 21, 7, 20.0));
  EXPECT_EQ(taper.width, 60.0);
  EXPECT_EQ(taper.wanted, 80.0);
  EXPECT_NEAR(taper.steepest, 2.0 / 3.0, 1e-12);
}

TEST(TaperProposal, IsOmittedForAReleaseThatThinsOut) {
  const Raster cone = release_of(30, 20, 21, 21, [](int column, int row) {
    return 22.0 - 2.0 * std::max(std::abs(column - 11), std::abs(row - 11));
  });
  EXPECT_EQ(propose_taper(plane(0.5), cone).width, 0.0) << "4 m thick next to its edge";
}

}  // namespace
}  // namespace thawslide::config
