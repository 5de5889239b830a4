// Cell sizes: warnings about too few particles or cells across a body, the cost of finer cells, sizes that divide the
// domain.
#include "config/resolution.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <stdexcept>

#include "case_messages.hpp"
#include "config/case_proposal.hpp"
#include "config/fitting_cell.hpp"

namespace thawslide::config {
namespace {

BodyOnCells body_on(double thickness, double cell, int particles_per_axis, bool has_maps, int dimension = 3) {
  return {.name = "slide",
          .thickness = thickness,
          .cell = cell,
          .particles_per_axis = particles_per_axis,
          .dimension = dimension,
          .has_maps = has_maps};
}

// Cell sizes that a warning proposes: all numbers between "to" and "m, at about".
std::vector<double> cells_named(const std::string& warning) {
  std::vector<double> cells;
  const std::regex named(R"( to ([0-9.]+) m, at about)");
  for (std::sregex_iterator each(warning.begin(), warning.end(), named), end; each != end; ++each) {
    cells.push_back(std::stod((*each)[1]));
  }
  return cells;
}

TEST(Resolution, WarnsOfTooFewParticlesAndForMapsOfTooFewCells) {
  for (const double thickness : {3.0, 24.0, 90.0}) {
    for (const int particles : {1, 2, 4}) {
      for (int tenths = 2; tenths <= 120; ++tenths) {
        const double cell = 10.0 * thickness / tenths;
        const bool lacks_particles = tenths * particles < 40, lacks_cells = tenths < 40;
        const std::string plain = resolution_warning(body_on(thickness, cell, particles, false), "grid.cell");
        const std::string maps = resolution_warning(body_on(thickness, cell, particles, true), "grid.cell");
        EXPECT_EQ(plain.empty(), !lacks_particles) << plain;
        EXPECT_EQ(maps.empty(), !lacks_particles && !lacks_cells) << maps;
        EXPECT_EQ(maps.find("too few particles") != std::string::npos, lacks_particles) << maps;
        EXPECT_EQ(maps.find("too few cells") != std::string::npos, lacks_cells) << maps;
      }
    }
  }
}

TEST(Resolution, AProposedCellIsFineEnough) {
  const std::vector<std::vector<double>> domains{{}, {960.0, 480.0, 240.0}, {96.0, 144.0, 48.0}};
  for (const auto& lengths : domains) {
    for (const double cell : {24.0, 12.0, 8.0, 6.0, 4.0}) {
      for (const double thickness : {5.0, 23.9, 24.0, 31.0}) {
        const std::string warning = resolution_warning(body_on(thickness, cell, 2, true), "grid.cell", lengths);
        const std::vector<double> cells = cells_named(warning);
        ASSERT_EQ(cells.empty(), warning.empty()) << warning;
        if (!cells.empty()) {
          EXPECT_EQ(resolution_warning(body_on(thickness, cells.back(), 2, true), "grid.cell", lengths), "") << warning;
          EXPECT_EQ(resolution_warning(body_on(thickness, cells.front(), 2, false), "grid.cell", lengths), "")
              << warning;
        }
        for (const double length : lengths) {
          for (const double named : cells) {
            EXPECT_NEAR(length / named, std::round(length / named), 1e-6) << warning;
          }
        }
      }
    }
  }
}

TEST(Resolution, WarningsStateTheFoundAndNeededNumbersAndTheCost) {
  EXPECT_EQ(
      resolution_warning(body_on(24.0, 8.0, 2, true), "grid.cell"),
      "grid.cell: across the median thickness of body slide, 24 m, there are too few cells for maps of thickness and "
      "area (found 3; needed 4). Set grid.cell to 6 m, at about 3.2 times the run time. Travel distance and speed need "
      "2.");
  EXPECT_EQ(
      resolution_warning(body_on(24.0, 30.0, 2, true), "grid.cell"),
      "grid.cell: across the median thickness of body slide, 24 m, there are too few particles to resolve shear "
      "and thinning (found 1.6; needed 4), and too few cells for maps of thickness and area (found 0.8; needed 4). "
      "Set grid.cell to 12 m, at about 39 times the run time, or for maps to 6 m, at about 630 times the run time.");
  EXPECT_EQ(resolution_warning(body_on(1.5, 1.0, 2, false, 2), "grid.cell", {20.0, 10.0}),
            "grid.cell: across the median thickness of body slide, 1.5 m, there are too few particles to resolve shear "
            "and thinning (found 3; needed 4). Set grid.cell to 0.5 m, at about 8 times the run time.");
}

TEST(Resolution, ANumberThatIsTooSmallIsRoundedDown) {
  for (const BodyOnCells& body : {body_on(3.99, 1.0, 2, true), body_on(3.99, 1.0, 1, false)}) {
    EXPECT_NE(resolution_warning(body, "grid.cell").find("(found 3.9; needed 4)"), std::string::npos);
  }
  EXPECT_EQ(resolution_warning(body_on(4.0 * (1.0 - 1e-12), 1.0, 2, true), "grid.cell"), "") << "round-off";
}

TEST(Resolution, RunTimeIsProportionalToCellsAndSteps) {
  EXPECT_EQ(run_time_factor(8.0, 4.0, 3), 16.0);
  EXPECT_EQ(run_time_factor(8.0, 4.0, 2), 8.0);
  EXPECT_EQ(run_time_factor(5.0, 5.0, 3), 1.0);
}

TEST(Resolution, MapsAreRequestedByTheirCellOrTheirMinimumThickness) {
  using namespace case_messages;
  write_map_files();
  const std::string& space = valid_case_on_dem;
  const auto asks = [](const std::string& file, const std::vector<std::string>& sets = {}) {
    return requests_maps(testing_support::case_from_text(file, sets));
  };
  EXPECT_FALSE(asks(valid_case));
  EXPECT_FALSE(asks(space));
  EXPECT_FALSE(asks(space + "[maps]\n"));
  EXPECT_TRUE(asks(space + "[maps]\narrival_thickness = 0.1\n")) << "at its default, and given";
  EXPECT_FALSE(asks(space + "[maps]\narrival_thickness = 0.1  # not given\n")) << "the case of a run";
  EXPECT_TRUE(asks(space, {"maps.cell=2.0"}));
}

// The comment in a case of `thawslide new` states the same cell and cost as the warning.
TEST(Resolution, TheCommentOfACaseAgreesWithTheWarning) {
  for (const double cell : {30.0, 12.0, 8.0, 6.1}) {
    BodyOnCells body = body_on(24.0, cell, 2, true);
    const std::string comment = maps_comment(body), warning = resolution_warning(body, "--cell");
    EXPECT_NE(comment.find("cells of 6 m (`thawslide new --resolution standard`), at about"), std::string::npos)
        << comment;
    const std::string cost = comment.substr(comment.find("at about"));
    EXPECT_NE(warning.find(cost.substr(0, cost.find('.', cost.find("times")))), std::string::npos) << warning;
  }
  BodyOnCells fine = body_on(24.0, 6.0, 2, true);
  EXPECT_EQ(maps_comment(fine), "");
}

TEST(Resolution, AProposedCaseHasTheComment) {
  Proposal proposal;
  proposal.thickness = proposal.median_thickness = 24.0;
  proposal.cell = 8.0;
  const std::string made = case_text(ProposalInput(), proposal);
  EXPECT_NE(made.find("cell = 8.0  # m; two particles a cell and axis make 6.0 across a thickness of 24 m\n" +
                      maps_comment(release_on_cells(proposal)) + "min = "),
            std::string::npos)
      << made;
  EXPECT_NE(maps_comment(release_on_cells(proposal)), "");
}

TEST(Resolution, HasTheCellsNeededForItsResults) {
  for (const double median : {1.3, 10.0, 24.0, 31.0}) {
    const double thickness = 1.2 * median;  // of half the volume
    for (const int particles : {1, 2, 4}) {
      const double quick = cell_of(Resolution::quick, thickness, median, particles);
      const double standard = cell_of(Resolution::standard, thickness, median, particles);
      EXPECT_GE(thickness / quick * particles, fewest_particles * (1.0 - 1e-9));
      EXPECT_LT(thickness / quick * particles, 1.4 * fewest_particles) << "not much finer than needed";
      EXPECT_GE(median / standard, cells_for_maps * (1.0 - 1e-9));
      EXPECT_EQ(resolution_warning(body_on(median, standard, 2, true), "--cell"), "");
      EXPECT_LT(median / standard, 1.4 * cells_for_maps);
      EXPECT_EQ(cell_of(Resolution::fine, thickness, median, particles), 0.5 * standard);
    }
  }
}

TEST(Resolution, IsFoundByItsName) {
  for (const ResolutionFacts& each : resolutions) {
    EXPECT_EQ(resolution_named(each.name), each.resolution);
  }
  EXPECT_THROW((void)resolution_named("coarse"), std::out_of_range);
}

TEST(Resolution, IsFoundByTheCellsAcrossABody) {
  EXPECT_EQ(resolution_with(1.9), nullptr);
  EXPECT_EQ(resolution_with(2.0)->resolution, Resolution::quick);
  EXPECT_EQ(resolution_with(3.9)->resolution, Resolution::quick);
  EXPECT_EQ(resolution_with(4.0)->resolution, Resolution::standard);
  EXPECT_EQ(resolution_with(20.0)->resolution, Resolution::fine);
  for (const ResolutionFacts& each : resolutions) {
    EXPECT_EQ(resolution_with(40.0 / cell_of(each.resolution, 40.0, 40.0, 2)), &each) << each.name;
  }
}

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
