// Results of band columns are mesh-independent: an elastic slab slides down an incline on cells of 20, 10 and 5 m.
#include <array>

#include "../support/column_slab.hpp"
#include "band/basal_segments.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

struct AtEnd {
  double velocity, displacement, temperature;
  double half_liquefied;  // time at which the pore pressure of half of the base exceeds half of its load [s]
};

// The base melts in the first seconds; then steam exerts pressure in the void left by melting, and friction decreases.
// Initial shear stress prevents oscillation of the slab.
AtEnd slide(const Sets& more) {
  const Sets sets{"body.slab.max=[400,80]; grid.max=[800,160]; body.slab.temperature=-0.1",
                  "body.slab.velocity=[10,0]; basal.friction_angle=35; mechanics.slope_shear=true"};
  Simulation<2> simulation(base_case("columns", sets + more));
  AtEnd result{};
  for (double end = 0.05; end < 5.0 + 1e-9; end += 0.05) {
    run_until(simulation, end);
    const double ratio = median_over_base(
        simulation, [&](const auto& segment) { return band::current_means(segment).pore_pressure / segment.load; });
    result.half_liquefied = result.half_liquefied == 0.0 && ratio > 0.5 ? end : result.half_liquefied;
  }
  const sim::HistoryRow row = sim::history_row(simulation);
  result.velocity = value_of(row, "mean_velocity_m_s");
  result.displacement = value_of(row, "mean_displacement_m");
  result.temperature =
      median_over_base(simulation, [&](const auto& segment) { return band::current_means(segment).temperature; });
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
TEST(BandColumnsVerification, TheAveragingTimeOfTheLoadAndTheTimeStepOfColumnsHaveNoEffect) {
  for (const auto& [sets, reference] : {std::pair(Sets{fine_column_step, "band.load_time=2.0"}, Sets{fine_column_step}),
                                        std::pair(Sets{}, Sets("band.column_step=0.0125"))}) {
    const AtEnd found = slide(sets), expected = slide(reference);
    EXPECT_NEAR(found.velocity, expected.velocity, 0.02 * expected.velocity);
    EXPECT_NEAR(found.temperature, expected.temperature, 0.02 * expected.temperature);
    EXPECT_NEAR(found.half_liquefied, expected.half_liquefied, 0.02 * expected.half_liquefied);
  }
}

}  // namespace
}  // namespace thawslide::verification
