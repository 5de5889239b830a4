// Input of the rigid block from a case.
#include "sim/block.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "../support/case_from_text.hpp"
#include "base/error.hpp"

namespace thawslide::sim {
namespace {

using testing_support::paper_case;

std::string slab(const std::string& state, const std::string& more = "") {
  return R"(
[case]
gravity_tilt = 30.0
[time]
end = 2.0
step = 0.002
history_interval = 0.5
[grid]
cell = 10.0
min = [-50.0, -10.0]
max = [500.0, 80.0]
[terrain]
type = "flat"
elevation = 0.0
[freezing]
curve = "power_law"
exponent = 5.0
[material.rock]
law = "elastic"
youngs_modulus = 1e9
poisson_ratio = 0.2
viscosity_time = 0.02
hydraulic_conductivity = 2e-8
[basal]
friction = "lubricated"
friction_angle = 20.0
[band]
thickness = 0.05
[body.slab]
material = "rock"
min = [0.0, 0.0]
max = [200.0, 50.0]
)" + state +
         more;
}

// At -1 C the power law gives a saturation of 1/(1 + ...) of water; if it is given as such, the state is the same.
TEST(Block, UsesSaturationAndIceContentForTemperatureAndPorosity) {
  const auto rows = run_block(paper_case(slab("temperature = -1.0\nporosity = 0.4\n")));
  double saturation = 0.0;
  for (const auto& [name, value] : rows.front()) {
    saturation = name == "band_saturation" ? value : saturation;
  }
  ASSERT_GT(saturation, 0.0);
  ASSERT_LT(saturation, 1.0);
  const auto same = run_block(paper_case(
      slab(fmt::format("saturation = {:.17g}\nice_content = {:.17g}\n", saturation, 0.4 * (1.0 - saturation)))));
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
    const auto rows = run_block(paper_case(slab("temperature = -1.0\nporosity = 0.4\n"), {"heat.masses=" + masses}));
    const std::map<std::string, double> last(rows.back().begin(), rows.back().end());
    EXPECT_GT(last.at("friction_heat_J_m2"), 1e5);
    return last.at("heat_gain_J_m2") / last.at("friction_heat_J_m2");
  };
  EXPECT_NEAR(gain_over_friction_heat("initial"), 1.0, 1e-9);
  EXPECT_GT(std::abs(gain_over_friction_heat("current") - 1.0), 1e-5);
}

TEST(Block, AcceptsOneBodyOfASectionOnly) {
  const std::string second = R"([body.other]
material = "rock"
min = [210.0, 0.0]
max = [250.0, 20.0]
)";
  try {
    run_block(paper_case(slab("temperature = -1.0\nporosity = 0.4\n", second)));
    FAIL() << "no error";
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("case.toml: the block model slides one body, and the case has 2. Use `thawslide run`."),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace thawslide::sim
