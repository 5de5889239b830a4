// Cell sizes: warnings about too few particles or cells across a body, and the cost of finer cells.
#include "config/resolution.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <stdexcept>

#include "case_messages.hpp"
#include "config/case_proposal.hpp"

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
  for (const double cell : {24.0, 12.0, 8.0, 6.0, 4.0}) {
    for (const double thickness : {5.0, 23.9, 24.0, 31.0}) {
      const std::string warning = resolution_warning(body_on(thickness, cell, 2, true), "grid.cell");
      const std::vector<double> cells = cells_named(warning);
      ASSERT_EQ(cells.empty(), warning.empty()) << warning;
      if (!cells.empty()) {
        EXPECT_EQ(resolution_warning(body_on(thickness, cells.back(), 2, true), "grid.cell"), "") << warning;
        EXPECT_EQ(resolution_warning(body_on(thickness, cells.front(), 2, false), "grid.cell"), "") << warning;
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
  EXPECT_EQ(resolution_warning(body_on(1.5, 1.0, 2, false, 2), "grid.cell"),
            "grid.cell: across the median thickness of body slide, 1.5 m, there are too few particles to resolve shear "
            "and thinning (found 3; needed 4). Set grid.cell to 0.6 m, at about 4.6 times the run time.");
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

}  // namespace
}  // namespace thawslide::config
