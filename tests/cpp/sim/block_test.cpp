// Input of the rigid block from a case.
#include "sim/block/block.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "../support/base_cases.hpp"
#include "../support/messages.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

const Variant slab{"slab", "case.gravity_tilt=30; time.history_interval=0.5; basal.friction_angle=20"};
const Sets frozen = "body.slab.temperature=-1; body.slab.porosity=0.4";

// At -1 C the power law gives a saturation of 1/(1 + ...) of water; if it is given as such, the state is the same.
TEST(Block, UsesSaturationAndIceContentForTemperatureAndPorosity) {
  const auto rows = run_block(paper_case(slab + frozen));
  double saturation = 0.0;
  for (const auto& [name, value] : rows.front()) {
    saturation = name == "band_saturation" ? value : saturation;
  }
  ASSERT_GT(saturation, 0.0);
  ASSERT_LT(saturation, 1.0);
  const auto same =
      run_block(paper_case(slab + fmt::format("body.slab.saturation={:.17g}; body.slab.ice_content={:.17g}", saturation,
                                              0.4 * (1.0 - saturation))));
  ASSERT_EQ(rows.size(), same.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    for (std::size_t column = 0; column < rows[k].size(); ++column) {
      const double value = rows[k][column].second;
      EXPECT_NEAR(same[k][column].second, value, 1e-9 * std::abs(value) + 1e-9) << rows[k][column].first;
    }
  }
}

// Rows gain all the heat of friction; with masses that follow the porosity, additional heat is created.
TEST(Block, UsesTheHeatMassesOfTheCase) {
  const auto gain_over_friction_heat = [](const std::string& masses) {
    const auto rows = run_block(paper_case(slab + frozen, {"heat.masses=" + masses}));
    const std::map<std::string, double> last(rows.back().begin(), rows.back().end());
    EXPECT_GT(last.at("friction_heat_J_m2"), 1e5);
    return last.at("heat_gain_J_m2") / last.at("friction_heat_J_m2");
  };
  EXPECT_NEAR(gain_over_friction_heat("initial"), 1.0, 1e-9);
  EXPECT_GT(std::abs(gain_over_friction_heat("current") - 1.0), 1e-5);
}

// A held block has the same motion, later by its release time.
TEST(Block, RestsUntilItsReleaseTime) {
  const Sets fixed = "time.step=0.002; time.stepping=fixed; time.end=3";
  const auto at_once = run_block(paper_case(slab + frozen + fixed));
  const auto held = run_block(paper_case(slab + frozen + fixed + Sets("body.slab.release_time=1")));
  ASSERT_EQ(held.size(), at_once.size());
  constexpr std::size_t rows_held = 2;  // of 0.5 s
  for (std::size_t k = 0; k < held.size(); ++k) {
    EXPECT_NEAR(held[k][0].second, at_once[k][0].second, 1e-9);
    for (std::size_t column = 1; column < held[k].size(); ++column) {
      EXPECT_EQ(held[k][column].second, at_once[k - std::min(k, rows_held)][column].second) << held[k][column].first;
    }
  }
  EXPECT_GT(held.back()[1].second, 1.0) << "m/s";
}

TEST(Block, AcceptsOneBodyOfASectionOnly) {
  const Sets second = "body.other.material=rock; body.other.min=[210,0]; body.other.max=[250,20]";
  expect_in(error_of([&] { run_block(paper_case(slab + frozen + second)); }),
            "case.toml: the block model slides one body, and the case has 2. Use `thawslide run`.");
}

}  // namespace
}  // namespace thawslide::sim
