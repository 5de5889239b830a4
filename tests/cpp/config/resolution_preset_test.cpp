// The cells of the resolutions that `thawslide new` offers by name.
#include "config/resolution_preset.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "config/resolution.hpp"

namespace thawslide::config {
namespace {

TEST(ResolutionPreset, HasTheCellsThatItsResultsNeed) {
  for (const double median : {1.3, 10.0, 24.0, 31.0}) {
    const double thickness = 1.2 * median;  // of half the volume
    for (const int particles : {1, 2, 4}) {
      const double quick = cell_of(Resolution::quick, thickness, median, particles);
      const double standard = cell_of(Resolution::standard, thickness, median, particles);
      EXPECT_GE(thickness / quick * particles, proposed_particles * (1.0 - 1e-9));
      EXPECT_LT(thickness / quick * particles, 1.4 * proposed_particles) << "not much finer than needed";
      EXPECT_GE(median / standard, cells_for_maps * (1.0 - 1e-9));
      EXPECT_LT(median / standard, 1.4 * cells_for_maps);
      EXPECT_EQ(cell_of(Resolution::fine, thickness, median, particles), 0.5 * standard);
    }
  }
}

TEST(ResolutionPreset, StandardNeedsNoNoteAboutMaps) {
  for (const double thickness : {1.3, 10.0, 24.0, 31.0}) {
    const double cell = cell_of(Resolution::standard, thickness, thickness, 2);
    const BodyOnCells body{.name = "slide", .thickness = thickness, .cell = cell, .has_maps = true};
    EXPECT_EQ(resolution_note(body, "--cell"), "");
  }
}

TEST(ResolutionPreset, IsFoundByItsName) {
  for (const ResolutionFacts& each : resolutions) {
    EXPECT_EQ(resolution_named(each.name), each.resolution);
  }
  EXPECT_THROW((void)resolution_named("coarse"), std::out_of_range);
}

}  // namespace
}  // namespace thawslide::config
