// Changes that make a case a trial.
#include "config/coarse_case.hpp"

#include <gtest/gtest.h>

namespace thawslide::config {
namespace {

TEST(CoarseCaseTest, CellsFixedStepsAndGivenMapCellsAreDoubled) {
  Case parameters;
  parameters.grid.cell = 5.0;
  parameters.time.step = 0.01;
  parameters.locations["time.step"] = "case.toml:3:1";
  parameters.maps.cell = 15.0;
  EXPECT_EQ(coarse_changes(parameters), (std::vector<std::string>{"grid.cell=10", "time.step=0.02", "maps.cell=30"}));
}

TEST(CoarseCaseTest, AdaptiveStepsAndMapsFollowTheCell) {
  Case parameters;
  parameters.grid.cell = 2.5;
  parameters.time.step = 100.0;  // its default, the end of the run
  parameters.maps.cell = 0.0;
  EXPECT_EQ(coarse_changes(parameters), std::vector<std::string>{"grid.cell=5"});
}

}  // namespace
}  // namespace thawslide::config
