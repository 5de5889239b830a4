// Results of band columns are mesh-independent: an elastic slab slides down an incline on cells of 20, 10 and 5 m.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "../support/case_from_text.hpp"
#include "../support/column_slab.hpp"
#include "../support/record.hpp"
#include "sim/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::verification {
namespace {

using namespace testing_support;

struct AtEnd {
  double velocity, displacement, temperature;
  double half_liquefied;  // time at which the pore pressure of half of the base exceeds half of its load [s]
};

// The base melts in the first seconds; then steam exerts pressure in the void left by melting, and friction decreases.
// Initial shear stress prevents oscillation of the slab.
AtEnd slide(const std::vector<std::string>& more) {
  std::vector<std::string> sets{"body.slab.max=[400.0, 80.0]", "grid.max=[800.0, 160.0]",
                                "body.slab.temperature=-0.1",  "body.slab.velocity=[10.0, 0.0]",
                                "basal.friction_angle=35.0",   "mechanics.slope_shear=true"};
  sets.insert(sets.end(), more.begin(), more.end());
  sim::Simulation<2> simulation(case_from_text(column_slab(), sets));
  const auto* columns = simulation.band_columns();
  AtEnd result{};
  for (double end = 0.05; end < 5.0 + 1e-9; end += 0.05) {
    run_until(simulation, end);
    const double ratio = median_over_base(
        simulation, [&](const auto& segment) { return columns->current_means(segment).pore_pressure / segment.load; });
    result.half_liquefied = result.half_liquefied == 0.0 && ratio > 0.5 ? end : result.half_liquefied;
  }
  const sim::HistoryRow row = sim::history_row(simulation);
  result.velocity = value_of(row, "mean_velocity_m_s");
  result.displacement = value_of(row, "mean_displacement_m");
  result.temperature =
      median_over_base(simulation, [&](const auto& segment) { return columns->current_means(segment).temperature; });
  return result;
}

// Half of the base is fully liquefied after 4.4 s; columns resolve this time to one of their steps.
constexpr const char* fine_column_step = "band.column_step=0.05";

TEST(BandColumnsVerification, SameHeatPressureAndMotionOnAnyMesh) {
  Record record("Band columns on three meshes",
                "An elastic slab of 400 m by 80 m is on a slope of 30 degrees. Its band of 0.1 m melts and boils; "
                "cells of 20, 10 and 5 m",
                "the same motion and temperature, and pore pressure at the same time", "mesh independence");
  const std::array<double, 3> cells{20.0, 10.0, 5.0};
  std::array<AtEnd, 3> found;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    found[k] =
        slide({fmt::format("grid.cell={}", cells[k]), fmt::format("time.step={}", 5e-4 * cells[k]), fine_column_step});
  }
  EXPECT_GT(found[2].half_liquefied, 3.0);
  for (std::size_t k = 0; k < 2; ++k) {
    const std::string on = fmt::format(", cells of {} m over 5 m", cells[k]);
    record.expect_near("velocity" + on, found[k].velocity / found[2].velocity, 1.0, 0.02);
    record.expect_near("displacement" + on, found[k].displacement / found[2].displacement, 1.0, 0.02);
    record.expect_near("temperature" + on, found[k].temperature / found[2].temperature, 1.0, 0.02);
    record.expect_near("time until it floats" + on, found[k].half_liquefied / found[2].half_liquefied, 1.0, 0.02);
  }
}

// N at nodes is intermittent; the averaging time must not have an effect.
TEST(BandColumnsVerification, TheAveragingTimeOfTheLoadHasNoEffect) {
  const AtEnd once = slide({fine_column_step}), twice = slide({fine_column_step, "band.load_time=2.0"});
  EXPECT_NEAR(twice.velocity, once.velocity, 0.02 * once.velocity);
  EXPECT_NEAR(twice.temperature, once.temperature, 0.02 * once.temperature);
  EXPECT_NEAR(twice.half_liquefied, once.half_liquefied, 0.02 * once.half_liquefied);
}

// The time step of columns has no effect, either.
TEST(BandColumnsVerification, TheTimeStepOfColumnsHasNoEffect) {
  const AtEnd coarse = slide({}), fine = slide({"band.column_step=0.0125"});
  EXPECT_NEAR(coarse.velocity, fine.velocity, 0.02 * fine.velocity);
  EXPECT_NEAR(coarse.temperature, fine.temperature, 0.02 * fine.temperature);
  EXPECT_NEAR(coarse.half_liquefied, fine.half_liquefied, 0.02 * fine.half_liquefied);
}

}  // namespace
}  // namespace thawslide::verification
