// Band columns do not depend on the mesh: an elastic slab slides down an incline on cells of 20, 10 and 5 m.
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
  double velocity, displacement, temperature, pressure;
};

// Thawed from the start, so that the pore pressure rises and friction falls with it.
AtEnd slide(const std::vector<std::string>& more) {
  std::vector<std::string> sets{"body.slab.max=[400.0, 80.0]", "grid.max=[800.0, 160.0]",
                                "body.slab.temperature=1.0",   "phases.water_expansion_law=constant",
                                "band.thickness=0.5",          "basal.friction_angle=35.0"};
  sets.insert(sets.end(), more.begin(), more.end());
  sim::Simulation<2, double> simulation(case_from_text(column_slab(), sets));
  run_until(simulation, 6.0);
  const sim::HistoryRow row = sim::history_row(simulation);
  const auto* columns = simulation.band_columns();
  return {value_of(row, "mean_velocity_m_s"), value_of(row, "mean_displacement_m"),
          median_over_base(simulation, [&](const auto& piece) { return columns->means_of(piece).temperature; }),
          median_over_base(simulation, [&](const auto& piece) { return columns->means_of(piece).pore_pressure; })};
}

TEST(BandColumnsVerification, SameHeatPressureAndMotionOnAnyMesh) {
  Record record("Band columns on three meshes",
                "thawed elastic slab of 400 m by 80 m on 30 degrees, band 0.5 m, on cells of 20, 10 and 5 m",
                "the same motion, temperature and pore pressure", "mesh independence");
  const std::array<double, 3> cells{20.0, 10.0, 5.0};
  std::array<AtEnd, 3> found;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    found[k] = slide({fmt::format("grid.cell={}", cells[k]), fmt::format("time.step={}", 5e-4 * cells[k])});
  }
  EXPECT_GT(found[2].pressure, 2e5);
  EXPECT_GT(found[2].velocity, 12.0) << "friction falls";
  for (std::size_t k = 0; k < 2; ++k) {
    const std::string on = fmt::format(", cells of {} m over 5 m", cells[k]);
    record.expect_near("velocity" + on, found[k].velocity / found[2].velocity, 1.0, 0.02);
    record.expect_near("displacement" + on, found[k].displacement / found[2].displacement, 1.0, 0.02);
    record.expect_near("temperature" + on, found[k].temperature / found[2].temperature, 1.0, 0.02);
    record.expect_near("pore pressure" + on, found[k].pressure / found[2].pressure, 1.0, 0.02);
  }
}

// N switches on and off at nodes; over how long it is averaged must not matter.
TEST(BandColumnsVerification, TheTimeOverWhichTheLoadIsAveragedDoesNotMatter) {
  const AtEnd once = slide({}), twice = slide({"band.load_time=2.0"});
  EXPECT_NEAR(twice.velocity, once.velocity, 0.02 * once.velocity);
  EXPECT_NEAR(twice.temperature, once.temperature, 0.02 * once.temperature);
  EXPECT_NEAR(twice.pressure, once.pressure, 0.02 * once.pressure);
}

// Nor does the time step of columns.
TEST(BandColumnsVerification, TheTimeStepOfColumnsDoesNotMatter) {
  const AtEnd coarse = slide({}), fine = slide({"band.column_step=0.0125"});
  EXPECT_NEAR(coarse.velocity, fine.velocity, 0.02 * fine.velocity);
  EXPECT_NEAR(coarse.temperature, fine.temperature, 0.02 * fine.temperature);
  EXPECT_NEAR(coarse.pressure, fine.pressure, 0.02 * fine.pressure);
}

}  // namespace
}  // namespace thawslide::verification
