// Guards of a run: energy without a physical cause, volumes out of range, non-finite values, too short time steps; and
// the removal of particles.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <regex>

#include "../support/base_cases.hpp"
#include "../support/messages.hpp"
#include "base/parallel.hpp"
#include "sim/records/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

// An oscillating block of 800 particles in free flight.
const Variant block{
    "free",
    "case.gravity=9.81; grid.cell=10; grid.min=[-50,-150]; grid.max=[300,150]; material.rock.youngs_modulus=5e8; "
    "material.rock.poisson_ratio=0.2; body.block.min=[0,0]; body.block.max=[100,50]; "
    "mechanics.initial_stress=geostatic; time.step=0.01; body.block.velocity=[20,0]"};

std::string failure_of(Simulation<2>& simulation, double dt, int steps) {
  set_thread_count(1);
  return error_of<RunError>([&] {
    for (int k = 0; k < steps; ++k) {
      simulation.step(dt);
    }
  });
}

std::string failure_of_next(Simulation<2>& simulation) {
  return error_of<RunError>([&] { (void)simulation.next_step(1.0); });
}

void expect_match(const std::string& text, const std::string& pattern) {
  EXPECT_TRUE(std::regex_match(text, std::regex(pattern))) << text;
}

std::size_t index_of(const Simulation<2>& simulation, std::int64_t id) {
  std::size_t p = 0;
  while (simulation.particles().id(p) != id) {
    ++p;
  }
  return p;
}

TEST(EnergyGuard, StableStepsPass) {
  Simulation<2> simulation(paper_case(block));
  EXPECT_EQ(failure_of(simulation, 0.9 * simulation.step_limit().step, 200), "no error");
}

TEST(EnergyGuard, AStepThatIsTooLongIsReportedWhileAllValuesAreFinite) {
  Simulation<2> simulation(paper_case(block));
  expect_match(
      failure_of(simulation, 2.1 * simulation.step_limit().step, 400),
      "the run failed at t = [0-9.]+ s \\(step [0-9]+\\): energy grew by [0-9.e+]+ J per m of width without a "
      "physical cause, [0-9.e+]+ % of all energy so far \\(guards.energy_growth allows 25 %\\)\\. The fastest "
      "particle, [0-9]+ of body 'block' at \\([0-9.]+, -?[0-9.]+\\) m, moves at [0-9.e+]+ m/s, the slide at "
      "[0-9.e+]+ m/s on average\\. Likely cause: the step is too long for the material, the material is too "
      "soft for its load, or it has separated\\. Try half of time.step, a larger viscosity_number or "
      "viscosity_time of the material, or mechanics.transfer = \"blend\" with mechanics.pic_fraction = 0.02\\.");
  for (std::size_t p = 0; p < simulation.particles().size(); ++p) {
    ASSERT_TRUE(std::isfinite(simulation.particles().velocity(p, 0) + simulation.particles().stress(p, 0)));
  }
}

TEST(EnergyGuard, CanBeDisabledAndNamesTheSafetyFactorOfAdaptiveSteps) {
  const auto failure_with = [](const Sets& sets) {
    Simulation<2> simulation(paper_case(block, sets));
    return failure_of(simulation, 2.1 * simulation.step_limit().step, 400);
  };
  const std::string failure = failure_with("guards.energy_growth=inf");
  EXPECT_EQ(failure.find("cause, "), std::string::npos) << failure;
  expect_in(failure, "the run failed at t = ");
  expect_in(failure_with("time.stepping=adaptive"), "Try half of time.safety");
}

TEST(VolumeGuard, EndsTheRunOutsideTheRange) {
  for (const auto& [ratio, what] :
       {std::pair("0.2", "its volume is 0\\.2[0-9]* of that at t = 0, where guards.smallest_volume allows 0\\.25"),
        std::pair("3", "its volume is 3(\\.[0-9]+)? of that at t = 0, where guards.largest_volume allows 2")}) {
    Simulation<2> simulation(paper_case(block, {"guards.largest_volume=2"}));
    simulation.particles().volume(index_of(simulation, 17)) *= std::stod(ratio);
    expect_match(failure_of(simulation, 0.005, 20),
                 "the run failed at t = 0\\.05 s \\(step 10\\): particle 17 of body 'block' at \\(.*\\) m: " +
                     std::string(what) + "\\. Likely cause: the step is too long .*");
  }
}

TEST(VolumeGuard, RemovesAndCounts) {
  Simulation<2> simulation(paper_case(block, {"guards.volume=remove"}));
  const double mass = simulation.particles().mass(index_of(simulation, 17));
  simulation.particles().volume(index_of(simulation, 17)) *= 0.2;
  EXPECT_EQ(failure_of(simulation, 0.005, 20), "no error");
  EXPECT_EQ(simulation.particles().size() + 1, simulation.particles_at_start());
  EXPECT_EQ(simulation.removed().volume, 1);
  EXPECT_EQ(simulation.removed().by_guards(), 1);
  EXPECT_EQ(text_of(simulation.removed()), "1 particle: 0 not finite, 1 by their volume");
  const HistoryRow row = history_row(simulation);
  EXPECT_EQ(value_of(row, "removed_mass_kg"), mass);
  EXPECT_EQ(value_of(row, "left_mass_kg"), mass);
  EXPECT_NEAR(value_of(row, "mass_residual_kg"), 0.0, 1e-12 * value_of(row, "mass_kg"));
  EXPECT_NEAR(value_of(row, "momentum_residual_x_N_s"), 0.0, 1e-9 * value_of(row, "momentum_x_N_s"));
  Simulation<2> other(paper_case(block, {"guards.not_finite=remove"}));
  other.particles().temperature(index_of(other, 17)) = no_number;  // without an effect on motion in this case
  EXPECT_EQ(failure_of(other, 0.005, 20), "no error");
  EXPECT_EQ(text_of(other.removed()), "1 particle: 1 not finite, 0 by their volume");
  EXPECT_EQ(value_of(history_row(other), "removed_mass_kg"), mass);
}

TEST(FiniteGuard, KeepsTheBudgetsOfTheRemainingParticles) {
  Simulation<2> simulation(paper_case(block, "guards.not_finite=remove; guards.removed_mass=0.6"));
  simulation.step(0.005);
  simulation.particles().velocity(index_of(simulation, 17), 0) = no_number;  // and of all that share nodes with it
  EXPECT_EQ(failure_of(simulation, 0.005, 20), "no error");
  EXPECT_GT(simulation.removed().not_finite, 1);
  EXPECT_EQ(simulation.particles().size() + static_cast<std::size_t>(simulation.removed().not_finite),
            simulation.particles_at_start());
  const HistoryRow row = history_row(simulation);
  for (const auto& [column, value] : row) {
    const bool has_no_base = column.rfind("band_", 0) == 0;
    EXPECT_TRUE(std::isfinite(value) || has_no_base) << column;
  }
  EXPECT_NEAR(value_of(row, "mass_residual_kg"), 0.0, 1e-12 * value_of(row, "mass_kg"));
  EXPECT_EQ(value_of(row, "removed_mass_kg"), value_of(row, "left_mass_kg"));
}

TEST(FiniteGuard, EndsTheRunThatHasLostTooMuchMass) {
  Simulation<2> simulation(paper_case(block, {"guards.not_finite=remove"}));
  simulation.step(0.005);
  simulation.particles().velocity(index_of(simulation, 17), 0) = no_number;
  expect_match(failure_of(simulation, 0.005, 20),
               "the run failed at t = 0\\.01 s \\(step 2\\): \\[guards\\] has removed [0-9]+ particles: [0-9]+ not "
               "finite, 0 by their volume, [0-9.]+ % of all mass, where guards.removed_mass allows 1 %; among the "
               "last: particle [0-9]+ of body 'block' at \\(.*\\) m: its .* is not a finite number\\. Likely cause: "
               ".*");
}

TEST(StepGuard, NamesTheLimitAndTheParticle) {
  Simulation<2> simulation(paper_case(block, {"time.stepping=adaptive"}));
  simulation.particles().volume(index_of(simulation, 17)) *= 1e7;
  expect_match(failure_of_next(simulation),
               "the run failed at t = 0 s \\(step 0\\): the next step would be [0-9.e-]+ s, 0\\.000[0-9]+ of the first "
               "one, 0\\.01 s, where guards.smallest_step allows 0\\.001\\. It is set by the elastic wave of material "
               "'rock' \\([0-9,]+ m/s\\) on cells of 10 m, of particle 17 of body 'block' at \\(.*\\) m, whose "
               "volume is 1e\\+07 of that at t = 0\\. Waves are faster in lighter material: the particle has "
               "expanded\\. Remove such particles with guards.volume = "
               "\"remove\" and a guards.largest_volume\\.");
}

TEST(StepGuard, NamesViscosityAndAParticleThatIsTooFast) {
  Simulation<2> viscous(paper_case(block, "time.stepping=adaptive; material.rock.viscosity_time=0.1"));
  viscous.particles().volume(index_of(viscous, 17)) *= 1e4;
  const std::string of_viscosity = failure_of_next(viscous);
  expect_in(of_viscosity, "It is set by the viscosity of material 'rock' (viscosity_time 0.1 s");
  expect_in(of_viscosity, "Try a smaller viscosity_number or viscosity_time of the material");
  Simulation<2> fast(paper_case(block, {"time.stepping=adaptive"}));
  fast.particles().velocity(index_of(fast, 17), 1) = 1e6;
  const std::string of_speed = failure_of_next(fast);
  expect_in(of_speed, "It is set by the particle speed of 1,000,000 m/s, of particle 17 of body 'block' at (");
  expect_in(of_speed, "try half of time.safety");
}

TEST(StepGuard, CountsTheStepsToTheEnd) {
  Simulation<2> simulation(paper_case(block, "time.stepping=adaptive; guards.most_steps=50"));
  const std::string failure = failure_of_next(simulation);
  expect_in(failure,
            "the next step would be 0.01 s, and 100 of them would be left to time.end, where "
            "guards.most_steps allows 50. It is set by the elastic wave");
}

}  // namespace
}  // namespace thawslide::sim
