// Rigid block: its input from a case, and its motion compared with the material points. Shear band of Sec. 3.2: a slab
// driven at constant speed over its melted base, adiabatic and undrained.
#include "sim/block/block.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "../support/base_cases.hpp"
#include "../support/messages.hpp"
#include "../support/record.hpp"
#include "base/portability.hpp"
#include "physics/pressurization.hpp"
#include "sim/records/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

const Variant tilted{"slab", "case.gravity_tilt=30; time.history_interval=0.5; basal.friction_angle=20"};
const Sets frozen = "body.slab.temperature=-1; body.slab.porosity=0.4";

// At -1 C the power law gives a saturation of 1/(1 + ...) of water; if it is given as such, the state is the same.
TEST(Block, UsesSaturationAndIceContentForTemperatureAndPorosity) {
  const auto rows = run_block(paper_case(tilted + frozen));
  double saturation = 0.0;
  for (const auto& [name, value] : rows.front()) {
    saturation = name == "band_saturation" ? value : saturation;
  }
  ASSERT_GT(saturation, 0.0);
  ASSERT_LT(saturation, 1.0);
  const auto same =
      run_block(paper_case(tilted + fmt::format("body.slab.saturation={:.17g}; body.slab.ice_content={:.17g}",
                                                saturation, 0.4 * (1.0 - saturation))));
  ASSERT_EQ(rows.size(), same.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    for (std::size_t column = 0; column < rows[k].size(); ++column) {
      const double value = rows[k][column].second;
      EXPECT_NEAR(same[k][column].second, value, 1e-9 * std::abs(value) + 1e-9) << rows[k][column].first;
    }
  }
}

TEST(Block, RowsGainAllTheHeatOfFriction) {
  const auto rows = run_block(paper_case(tilted + frozen));
  const std::map<std::string, double> last(rows.back().begin(), rows.back().end());
  EXPECT_GT(last.at("friction_heat_J_m2"), 1e5);
  EXPECT_NEAR(last.at("heat_gain_J_m2") / last.at("friction_heat_J_m2"), 1.0, 1e-9);
}

// A held block has the same motion, later by its release time.
TEST(Block, RestsUntilItsReleaseTime) {
  const Sets fixed = "time.step=0.002; time.stepping=fixed; time.end=3";
  const auto at_once = run_block(paper_case(tilted + frozen + fixed));
  const auto held = run_block(paper_case(tilted + frozen + fixed + Sets("body.slab.release_time=1")));
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
  expect_in(error_of([&] { run_block(paper_case(tilted + frozen + second)); }),
            "case.toml: the block model slides one body, and the case has 2. Use `thawslide run`.");
}

using namespace testing_support;
using verification::Record;

// The friction coefficient is 0.2.
const Variant slab{
    "slab",
    "time.end=1.5; time.step=0.001; grid.max=[250,80]; material.rock.youngs_modulus=5e8; body.slab.temperature=1e-9; "
    "body.slab.velocity=[1,0]; frame.driver.min=[-50,-10]; frame.driver.max=[250,80]; frame.driver.axis=x; "
    "frame.driver.velocity=1; basal.friction=constant; basal.friction_angle=11.30993247402; heat.conduction=false; "
    "heat.advection=false; pressure.seepage=false"};

// The frame drives all nodes except those of the base.
const Sets base_free = "frame.driver.min=[-50.0,5.0]";

// Effective friction coefficient: basal shear force over normal force, from two rows of particles per band.
TEST(AdiabaticBand, FrictionFallsExponentiallyWithTheFactorOfTwoRows) {
  Record record("Adiabatic, undrained band of two particle rows",
                "A melted slab of 50 m driven at 1 m/s, band of 0.05 m in cells of 10 m, no conduction and no seepage.",
                "tau = mu (N - P0) exp(-1.25 mu Lambda V t/(C e)), 1.25 = 2 (w1^2 + w2^2)/(w1 + w2), w = 3/4 and 1/4",
                "Rice 2006, with the band's two rows");
  Simulation<2> simulation(paper_case(slab, base_free));
  const auto& model = simulation.model();
  const auto& phases = model.motion.phases;
  const double n = 0.375, gravity = 9.81, height = 50.0, thickness = 0.05, mu = 0.2, speed = 1.0;
  const double density = physics::mixture_density(phases, n, 1.0);
  const double normal = density * gravity * height;
  const double pressure = phases.water_density / phases.ice_density * phases.ice_density * gravity * height;
  const double lambda = physics::undrained_pressure_coefficient(phases, n, 1.0);
  const double capacity = physics::heat_capacity(phases, n, 1.0);
  // Node pressure rises 2 (w1^2 + w2^2)/(w1 + w2) = 1.25 times faster than the mean, with w = 3/4 and 1/4.
  const double rate = 1.25 * mu * lambda * speed / (capacity * thickness);
  double shear = 0.0;
  int samples = 0;
  while (simulation.time() < 1.5 - 1e-9) {
    simulation.step(0.001);
    // Mean over a tenth of a second, because the slab's elastic waves oscillate around the mean.
    if (simulation.time() > 1.4) {
      shear += std::abs(simulation.contact().force[0]) / 200.0;
      ++samples;
    }
  }
  const double expected = mu * (normal - pressure) * std::exp(-rate * 1.45);
  record.expect_near("friction after 1.45 m over exact", shear / samples / expected, 1.0, 0.01);
  // Without the factor, the result would differ by far.
  EXPECT_GT(std::exp(-rate / 1.25 * 1.45) / std::exp(-rate * 1.45), 1.1);
}

TEST(AdiabaticBand, BlockModelFollowsTheSameExponential) {
  // A block heavy enough to keep its speed; gravity is tilted such that it slides at constant speed with constant
  // friction.
  const config::Case parameters =
      paper_case(slab, {"time.end=0.5", "body.slab.velocity=[1.0,0.0]", "case.gravity_tilt=0.0", "time.step=0.0005"});
  Record record("The same band in the rigid block", "The rigid-block model with its base as above.",
                "ln(N - P) falls by 1.25 mu Lambda/(C e) per metre of slip", "docs/theory/block-model.md");
  const auto rows = run_block(parameters);
  const auto& first = rows.front();
  const auto& last = rows.back();
  const double lambda = 325000.0, capacity = 3042156.25;
  // d ln(N - P)/d(slip) = -1.25 mu Lambda/(C e), for any speed.
  const double slip = value_of(last, "displacement_m");
  const double decay = std::log((value_of(last, "normal_pressure_Pa") - value_of(last, "pore_pressure_Pa")) /
                                (value_of(first, "normal_pressure_Pa") - value_of(first, "pore_pressure_Pa")));
  record.expect_near("fall of ln(N - P) per metre [1/m]", decay / slip, -1.25 * 0.2 * lambda / (capacity * 0.05),
                     0.005);
  EXPECT_GT(slip, 0.2);
}

// Frozen, melting and pressurized base under gravity: the deformable slab compared with the rigid block.
const Variant sliding{
    "slab",
    "case.gravity_tilt=25; time.end=6; time.step=0.001; time.history_interval=0.5; material.rock.youngs_modulus=5e9; "
    "body.slab.temperature=-1; body.slab.velocity=[2,0]; mechanics.slope_shear=true"};

TEST(BlockModel, AgreesWithTheMaterialPoints) {
  const config::Case parameters = paper_case(sliding, {"time.step=0.0005"});
  const auto rows = run_block(parameters);
  Simulation<2> simulation(parameters);
  run_until(simulation, parameters.time.end);
  const auto row = history_row(simulation);
  const auto& block = rows.back();
  Record record("Deformable slab and rigid block",
                "A slab of 200 m by 50 m at -1 C slides down 25 degrees for 6 s: its base melts and is pressurized. "
                "The rigid block follows an ordinary differential equation, on one column of the same band.",
                "the same motion, heat and pressure", "docs/theory/block-model.md");
  record.expect_near("velocity, slab over block", value_of(row, "mean_velocity_m_s") / value_of(block, "velocity_m_s"),
                     1.0, 0.02);
  record.expect_near("displacement, slab over block",
                     value_of(row, "mean_displacement_m") / value_of(block, "displacement_m"), 1.0, 0.02);
  record.expect_near("friction work, slab over block",
                     value_of(row, "friction_work_J") / 200.0 / value_of(block, "friction_work_J_m2"), 1.0, 0.02);
  // The two ends of the slab are warmer than its long middle.
  EXPECT_NEAR(value_of(row, "band_temperature_C"), value_of(block, "band_temperature_C"), 0.25);
  EXPECT_NEAR(value_of(row, "band_saturation") / value_of(block, "band_saturation"), 1.0, 0.05);
  EXPECT_NEAR(value_of(row, "band_pore_pressure_Pa") / value_of(block, "band_pore_pressure_Pa"), 1.0, 0.05);
  EXPECT_GT(value_of(block, "band_saturation"), 0.3) << "the base must have begun to melt for this to say much";
}

// The same with the balance of water: ice does not press, its rows are sealed, the skeleton is compressible and the
// load is followed.
TEST(BlockModel, AgreesWithTheMaterialPointsWithTheBalanceOfWater) {
  const config::Case parameters = paper_case(sliding,
                                             "time.step=0.0005; pressure.frozen=none; pressure.residual_stress=2e5; "
                                             "pressure.frozen_rows=sealed; pressure.skeleton_compressibility=5e-9; "
                                             "phases.water_expansion_law=by_temperature; body.slab.temperature=-0.05; "
                                             "material.rock.hydraulic_conductivity=1e-10");
  const auto rows = run_block(parameters);
  Simulation<2> simulation(parameters);
  run_until(simulation, parameters.time.end);
  const auto row = history_row(simulation);
  const auto& block = rows.back();
  EXPECT_EQ(value_of(rows.front(), "pore_pressure_Pa"), 0.0);
  EXPECT_NEAR(value_of(row, "mean_velocity_m_s") / value_of(block, "velocity_m_s"), 1.0, 0.02);
  EXPECT_NEAR(value_of(row, "friction_work_J") / 200.0 / value_of(block, "friction_work_J_m2"), 1.0, 0.02);
  EXPECT_NEAR(value_of(row, "band_temperature_C"), value_of(block, "band_temperature_C"), 0.25);
  EXPECT_NEAR(value_of(row, "band_pore_pressure_Pa") / value_of(block, "band_pore_pressure_Pa"), 1.0, 0.05);
  EXPECT_GT(value_of(block, "band_pore_pressure_Pa"), 1e5) << "the base must have melted for this to say much";
}

// With the scaling restricted to the band, the rows above conduct less heat out of it.
TEST(BlockModel, FollowsTheRegionOfTheScaling) {
  const config::Case parameters = paper_case(sliding, {"band.region=first_layer"});
  const auto block = run_block(parameters).back(), scaled_all = run_block(paper_case(sliding)).back();
  Simulation<2> simulation(parameters);
  run_until(simulation, parameters.time.end);
  const auto row = history_row(simulation);
  EXPECT_NEAR(value_of(row, "friction_work_J") / 200.0 / value_of(block, "friction_work_J_m2"), 1.0, 0.01);
  EXPECT_NEAR(value_of(row, "band_temperature_C"), value_of(block, "band_temperature_C"), 0.25);
  EXPECT_GT(value_of(block, "friction_work_J_m2") / value_of(scaled_all, "friction_work_J_m2"), 1.03);
  EXPECT_GT(value_of(block, "band_temperature_C"), value_of(scaled_all, "band_temperature_C") + 1.0);
}

// Adaptive stepping uses the limits of the run, with the maximum set by time.step, and gives the same result as fixed
// steps.
TEST(BlockModel, StepsAdaptively) {
  const auto fixed = run_block(paper_case(sliding, {"time.step=0.001"}));
  const auto rows = run_block(paper_case(sliding, "time.stepping=adaptive; time.step=0.002"));
  EXPECT_NEAR(value_of(rows.back(), "velocity_m_s") / value_of(fixed.back(), "velocity_m_s"), 1.0, 1e-3);
  const auto free = run_block(paper_case(sliding, "time.stepping=adaptive; time.step="));
  EXPECT_NEAR(value_of(free.back(), "velocity_m_s") / value_of(fixed.back(), "velocity_m_s"), 1.0, 2e-3);
}

}  // namespace
}  // namespace thawslide::sim
