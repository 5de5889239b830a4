// The complete Lamplugh run: numbers in its README, and budgets that close until the end.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/case_from_text.hpp"
#include "sim/records/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

TEST(WholeLamplugh, RunoutAndStopAreNearTheReportedValues) {
  Simulation<2> simulation(config::read_case(THAWSLIDE_SOURCE_DIR "/cases/lamplugh"));
  double peak = 0.0, rests_at = 0.0, displacement_at_rest = 0.0;
  while (simulation.time() < 200.0 - 1e-9) {
    run_until(simulation, simulation.time() + 1.0);
    peak = std::max(peak, value_of(history_row(simulation), "mean_velocity_m_s"));
    if (rests_at == 0.0 && simulation.ends_at_rest()) {
      rests_at = simulation.time();
      displacement_at_rest = value_of(history_row(simulation), "mean_displacement_m");
    }
  }
  const auto row = history_row(simulation);
  EXPECT_NEAR(peak, 80.0, 4.0);
  EXPECT_NEAR(value_of(row, "mean_displacement_m"), 5770.0, 160.0);
  // A run of the case would end here, with the results of the end.
  EXPECT_GT(rests_at, 100.0);
  EXPECT_NEAR(displacement_at_rest, value_of(row, "mean_displacement_m"), 0.05);
  EXPECT_LT(value_of(row, "mean_velocity_m_s"), 0.01);
  const double work = value_of(row, "friction_work_J");
  EXPECT_LT(std::abs(value_of(row, "mechanical_residual_J")), 2e-3 * work);
  EXPECT_LT(std::abs(value_of(row, "thermal_residual_J")), 1e-10 * value_of(row, "friction_heat_J"));
  for (const std::string axis : {"x", "y"}) {
    EXPECT_LT(std::abs(value_of(row, "momentum_residual_" + axis + "_N_s")),
              1e-9 * std::abs(value_of(row, "gravity_impulse_y_N_s")));
  }
}

}  // namespace
}  // namespace thawslide::sim
