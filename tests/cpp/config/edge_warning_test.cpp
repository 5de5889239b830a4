// Warnings of `thawslide new` about a release near the edge of the known terrain.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "config/case_proposal.hpp"

namespace thawslide::config {
namespace {

constexpr double cell = 10.0;  // of the DEM [m]

Raster level_points(int columns, int rows) {
  Raster raster;
  raster.x = 1000.0;
  raster.y = 2000.0;
  raster.cell_x = raster.cell_y = cell;
  raster.columns = columns;
  raster.rows = rows;
  raster.values.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 500.0);
  return raster;
}

// 10 x 8 points; the release ends a cell beyond them: 110 m x 90 m.
Raster release_at(const Raster& dem, int first_column, int first_row) {
  Raster raster = dem.filled(0.0);
  for (int row = first_row; row < first_row + 8; ++row) {
    for (int column = first_column; column < first_column + 10; ++column) {
      raster.values[raster.index(column, row)] = 20.0;
    }
  }
  return raster;
}

TEST(EdgeWarning, IsGivenIfTheEdgeIsNearerThanTheLengthOfTheRelease) {
  const Raster dem = level_points(60, 60);
  for (int first = 1; first < 49; first += 4) {
    for (const bool along_x : {true, false}) {
      const Proposal proposal = propose(dem, along_x ? release_at(dem, first, 25) : release_at(dem, 25, first), 20.0);
      EXPECT_EQ(proposal.length, 110.0);
      const int last = first + (along_x ? 9 : 7);
      const double distance = std::min(110.0, cell * std::min(first - 1, 58 - last));
      EXPECT_EQ(proposal.edge_distance, distance) << first;
      EXPECT_EQ(edge_warning(proposal).empty(), distance >= 110.0) << first;
    }
  }
  EXPECT_EQ(edge_warning(propose(dem, release_at(dem, 4, 25), 20.0)),
            "--dem: the release is close to the edge of the known terrain (found 30 m; needed at least its own length, "
            "110 m). Particles that pass the edge are removed, and the results do not include them. Use a larger DEM");
}

TEST(EdgeWarning, IsGivenForPointsWithoutData) {
  Raster dem = level_points(60, 60);
  const Raster release = release_at(dem, 25, 25);  // from 1240 to 1350 m and from 2240 to 2330 m
  EXPECT_EQ(edge_warning(propose(dem, release, 20.0)), "");
  dem.values[dem.index(38, 37)] = std::nan("");  // 30 m to the east and 40 m to the north
  const Proposal proposal = propose(dem, release, 20.0);
  EXPECT_NEAR(proposal.edge_distance, 50.0, 1e-9);
  EXPECT_NE(edge_warning(proposal).find("(found 50 m; needed at least its own length, 110 m"), std::string::npos);
}

TEST(EdgeWarning, IsGivenForACaseThatRemovesLeavingParticles) {
  const Raster dem = level_points(60, 60);
  ProposalInput input;
  input.dem_file = "dem.tif";
  input.release_file = "release.geojson";
  input.thickness = {MapValue::From::number, 20.0, ""};
  const std::string text = case_text(input, propose(dem, release_at(dem, 25, 25), 20.0));
  EXPECT_NE(
      text.find("\nleaving = \"remove\"  # what leaves the domain or the DEM is removed, and its mass reported; "),
      std::string::npos)
      << text;
}

}  // namespace
}  // namespace thawslide::config
