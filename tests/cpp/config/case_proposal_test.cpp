// The domain that `thawslide new` proposes contains the release, whose edge and top lie between points of the DEM, and
// the warnings about a release near the edge of the known terrain.
#include "config/case_proposal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/small_terrain.hpp"
#include "sim/between_steps/monitor.hpp"

namespace thawslide::config {
namespace {

using testing_support::raster;

constexpr double cell = 10.0;  // of the DEM [m]

// 60 columns of points, the first at 1000, 2000, of a plane that falls to the east.
Raster dem_points(double slope = 0.8, int rows = 40) {
  return raster(1000.0, 2000.0, cell, 60, rows, [=](double x, double) { return 500.0 - slope * (x - 1000.0); });
}

// A release of 10 x 8 points; thickness of a point by its row.
Raster release_of_rows(int first_column, int first_row, int rows, const std::function<double(int)>& thickness) {
  return raster(1000.0, 2000.0, cell, 60, rows, [&](double x, double y) {
    const auto column = static_cast<int>(std::lround((x - 1000.0) / cell)) - first_column;
    const auto row = static_cast<int>(std::lround((y - 2000.0) / cell)) - first_row;
    return column >= 0 && column < 10 && row >= 0 && row < 8 ? thickness(row) : 0.0;
  });
}
Raster release_at(int first_column, int first_row, double thickness, int rows = 40) {
  return release_of_rows(first_column, first_row, rows, [=](int) { return thickness; });
}

TEST(CaseProposal, ContainsAReleaseThinnerThanASlopeAcrossACellOfTheDem) {
  for (const double thickness : {3.0, 1.0, 0.1}) {
    const Proposal proposal = propose(dem_points(), release_at(20, 15, thickness), 44.0);
    EXPECT_EQ(proposal.thickness, thickness);
    EXPECT_NEAR(proposal.volume, 80.0 * cell * cell * thickness, 1e-6);
    const double margin = margin_cells * proposal.cell;
    EXPECT_LE(proposal.min[0], 1190.0 - margin);
    EXPECT_GE(proposal.max[0], 1300.0 + margin);
    EXPECT_LE(proposal.min[1], 2140.0 - margin);
    EXPECT_GE(proposal.max[1], 2230.0 + margin);
    // The point to the west of the release is 8 m above its highest one.
    EXPECT_GE(proposal.max[2], 500.0 - 0.8 * 190.0 + thickness + margin);
    EXPECT_LE(proposal.min[2], 500.0 - 0.8 * 300.0 - thickness - margin) << "space for an excavated release";
  }
}

// Half of 80 points are 4 m thick, the others 20 m: five sixths of the volume are in the thicker half.
TEST(CaseProposal, TheCellFollowsTheVolumeAndTheMedianTheArea) {
  Raster release = release_of_rows(20, 15, 40, [](int row) { return row < 4 ? 4.0 : 20.0; });
  release.values[0] = std::nan("");
  const Proposal proposal = propose(dem_points(), release, 20.0);
  EXPECT_EQ(proposal.thickness, 20.0);
  EXPECT_EQ(proposal.median_thickness, 4.0);
  EXPECT_EQ(median_thickness(release), 4.0);
  EXPECT_EQ(proposal.cell, 10.0) << "four particles across 20 m";
}

TEST(CaseProposal, TheCellIsThatOfTheResolutionUnlessTheUserGivesOne) {
  const Raster release = release_at(20, 15, 20.0);
  const Proposal standard = propose(dem_points(), release, 20.0, 0.0, Resolution::standard);
  EXPECT_EQ(standard.cell, 5.0) << "four cells across 20 m";
  EXPECT_EQ(propose(dem_points(), release, 20.0, 0.0, Resolution::fine).cell, 2.5);
  EXPECT_EQ(propose(dem_points(), release, 20.0, 4.0, Resolution::fine).cell, 4.0);
  EXPECT_EQ(case_text(ProposalInput(), standard).find("Maps of thickness and area need"), std::string::npos);
}

// A case contains the name of a file with any characters.
TEST(CaseProposal, NamesAreTomlStrings) {
  const std::string name = "x\"\n[time]\nend = 5\n#\\.geojson";
  ProposalInput input;
  input.title = input.release_file = name;
  input.dem_file = "dem.tif";
  input.thickness = {MapValue::From::attribute, 0.0, "thick\"ness"};
  const std::string escaped = R"("x\"\u000a[time]\u000aend = 5\u000a#\\.geojson")";
  const std::string text = case_text(input, propose(dem_points(), release_at(20, 15, 20.0), 20.0));
  EXPECT_NE(text.find("\ntitle = " + escaped + "\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\nrelease = " + escaped + "\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\nthickness = { attribute = \"thick\\\"ness\" }  # m\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("\nend = 5\n"), std::string::npos) << "names create no keys";
  const std::string section = section_text(name, name, Proposal());
  EXPECT_NE(section.find("\ntitle = " + escaped + "\n"), std::string::npos) << section;
  EXPECT_NE(section.find("\nfile = " + escaped + "\n"), std::string::npos) << section;
}

// The value is the rest speed of a run without the key.
TEST(CaseProposal, RunsEndAtRest) {
  const std::string line = fmt::format("\nstop_at_rest = {:g}  # m/s; ", sim::usual_rest_speed);
  const Proposal proposal = propose(dem_points(), release_at(20, 15, 20.0), 20.0);
  EXPECT_NE(case_text(ProposalInput(), proposal).find(line), std::string::npos);
  EXPECT_NE(section_text("title", "profile.csv", proposal).find(line), std::string::npos);
}

TEST(CaseProposal, BeginsAtTheEdgeOfTheDemIfAMultipleOfTheCellWouldCutTheRelease) {
  const Proposal west = propose(dem_points(), release_at(1, 1, 12.0), 8.0);
  EXPECT_EQ(west.cell, 6.0);
  EXPECT_EQ(west.min[0], 1000.0) << "a multiple of 6 m would be 1002 m";
  EXPECT_EQ(west.min[1], 2000.0);
  const Proposal east = propose(dem_points(), release_at(49, 31, 12.0), 8.0);
  EXPECT_EQ(east.max[0], 1590.0);
  EXPECT_EQ(east.max[1], 2390.0);
  for (const Proposal& proposal : {west, east}) {
    for (std::size_t a = 0; a < 3; ++a) {
      const double cells = (proposal.max[a] - proposal.min[a]) / proposal.cell;
      EXPECT_NEAR(cells, std::round(cells), 1e-9) << "axis " << a;
    }
    EXPECT_GE(proposal.min[0], 1000.0);
    EXPECT_LE(proposal.max[0], 1590.0);
    EXPECT_GE(proposal.min[1], 2000.0);
    EXPECT_LE(proposal.max[1], 2390.0);
  }
}

// The release of 10 x 8 points ends a cell beyond them: 110 m x 90 m.
TEST(EdgeWarning, IsGivenIfTheEdgeIsNearerThanTheLengthOfTheRelease) {
  const Raster dem = dem_points(0.0, 60);
  for (int first = 1; first < 49; first += 4) {
    for (const bool along_x : {true, false}) {
      const Proposal proposal =
          propose(dem, along_x ? release_at(first, 25, 20.0, 60) : release_at(25, first, 20.0, 60), 20.0);
      EXPECT_EQ(proposal.length, 110.0);
      const int last = first + (along_x ? 9 : 7);
      const double distance = std::min(110.0, cell * std::min(first - 1, 58 - last));
      EXPECT_EQ(proposal.edge_distance, distance) << first;
      EXPECT_EQ(edge_warning(proposal).empty(), distance >= 110.0) << first;
    }
  }
  EXPECT_EQ(edge_warning(propose(dem, release_at(4, 25, 20.0, 60), 20.0)),
            "--dem: the release is close to the edge of the known terrain (found 30 m; needed at least its own length, "
            "110 m). Particles that pass the edge are removed, and the results do not include them. Use a larger DEM");
}

TEST(EdgeWarning, IsGivenForPointsWithoutData) {
  Raster dem = dem_points(0.0, 60);
  const Raster release = release_at(25, 25, 20.0, 60);  // from 1240 to 1350 m and from 2240 to 2330 m
  EXPECT_EQ(edge_warning(propose(dem, release, 20.0)), "");
  dem.values[dem.index(38, 37)] = std::nan("");  // 30 m to the east and 40 m to the north
  const Proposal proposal = propose(dem, release, 20.0);
  EXPECT_NEAR(proposal.edge_distance, 50.0, 1e-9);
  EXPECT_NE(edge_warning(proposal).find("(found 50 m; needed at least its own length, 110 m"), std::string::npos);
}

TEST(EdgeWarning, IsGivenForACaseThatRemovesLeavingParticles) {
  const Raster dem = dem_points(0.0, 60);
  ProposalInput input;
  input.dem_file = "dem.tif";
  input.release_file = "release.geojson";
  input.thickness = {MapValue::From::number, 20.0, ""};
  const std::string text = case_text(input, propose(dem, release_at(25, 25, 20.0, 60), 20.0));
  EXPECT_NE(
      text.find("\nleaving = \"remove\"  # what leaves the domain or the DEM is removed, and its mass reported; "),
      std::string::npos)
      << text;
}

}  // namespace
}  // namespace thawslide::config
