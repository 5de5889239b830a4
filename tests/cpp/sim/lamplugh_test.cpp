// The Lamplugh case, shortened: budgets, and runs that fail.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../support/base_cases.hpp"
#include "../support/messages.hpp"
#include "physics/mixture.hpp"
#include "sim/records/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

config::Case lamplugh(const Sets& sets = {}) {
  return config::read_case(THAWSLIDE_SOURCE_DIR "/cases/lamplugh", Sets("time.stepping=fixed; time.step=0.005") + sets);
}

// Fast from the start, such that a few seconds include sliding, melting, pressurization and yield.
const Sets hasty = "body.slide.velocity=[20.0,-22.0]; basal.slip_distance=20.0";

TEST(Budget, ClosesOnAShortLamplugh) {
  double residual[2];
  for (int k = 0; k < 2; ++k) {
    Simulation<2> simulation(lamplugh(hasty + (k == 0 ? "time.step=0.005" : "time.step=0.0025")));
    const auto start = history_row(simulation);
    run_until(simulation, 5.0);
    const auto row = history_row(simulation);
    EXPECT_EQ(value_of(row, "mass_kg"), value_of(start, "mass_kg"));
    EXPECT_DOUBLE_EQ(value_of(row, "rock_kg"), value_of(start, "rock_kg"));
    EXPECT_NEAR((value_of(row, "ice_kg") + value_of(row, "water_kg")) /
                    (value_of(start, "ice_kg") + value_of(start, "water_kg")),
                1.0, 1e-12);
    EXPECT_GT(value_of(row, "water_kg"), value_of(start, "water_kg"));
    // Water produced equals the latent heat over L_f: both use the volume over xi = 200.
    const double melted = (value_of(row, "latent_J") - value_of(start, "latent_J")) / 333.5e3;
    EXPECT_NEAR((value_of(row, "water_kg") - value_of(start, "water_kg")) / melted, 1.0, 1e-4);
    const double work = value_of(row, "friction_work_J");
    EXPECT_GT(work, 1e12);
    EXPECT_NEAR(value_of(row, "friction_heat_J") / work, 0.35, 1e-12);
    EXPECT_NEAR(value_of(row, "thermal_residual_J") / value_of(row, "friction_heat_J"), 0.0, 1e-10);
    residual[k] = std::abs(value_of(row, "mechanical_residual_J")) / work;
    EXPECT_GT(value_of(row, "plastic_J"), 0.0);
    EXPECT_GT(value_of(row, "latent_J"), 0.0);
  }
  EXPECT_LT(residual[0], 0.03);
  EXPECT_LT(residual[1], 0.75 * residual[0]) << "the residual is the error of the time step";
}

std::string failure_of(Simulation<2>& simulation, int steps) {
  return error_of<RunError>([&] {
    for (int k = 0; k < steps; ++k) {
      simulation.step(0.01);
    }
  });
}

TEST(Fault, NotANumberNamesParticlePlaceAndTime) {
  Simulation<2> simulation(lamplugh());
  simulation.step(0.01);
  simulation.particles().velocity(17, 0) = std::numeric_limits<double>::quiet_NaN();
  const std::string message = failure_of(simulation, 2);
  expect_in(message, "the run failed at t = 0.02 s (step 2): particle ");
  expect_in(message, "of body 'slide' at (");
  expect_in(message, "is not a finite number");
  expect_in(message, "Likely cause: ");
}

TEST(Fault, ClosedPoresAreNamedAsTheCause) {
  Simulation<2> simulation(lamplugh());
  simulation.step(0.01);
  for (const std::size_t p : {17, 18}) {
    simulation.particles().porosity(p) = physics::smallest_porosity;
    simulation.particles().heat_content(p) = 3e10;   // about 10,000 C
    simulation.particles().temperature(p) = 1000.0;  // heating continues, such that the pores remain closed
  }
  simulation.particles().velocity(simulation.particles().size() - 1, 0) = std::numeric_limits<double>::quiet_NaN();
  const std::string message = failure_of(simulation, 2);
  expect_in(message, "the pores of ");
  expect_in(message, "hottest particle: 9");
  expect_in(message, "basal.heat_fraction");
}

TEST(Fault, PoresClosedByAnImpactAreNamedAsTheCause) {
  Simulation<2> simulation(lamplugh());
  simulation.particles().volume(17) = 0.64 * simulation.particles().initial_volume(17);
  simulation.particles().velocity(simulation.particles().size() - 1, 0) = std::numeric_limits<double>::quiet_NaN();
  const std::string message = failure_of(simulation, 2);
  expect_in(message, "compressed a particle to 0.6");
  expect_in(message, "Set pressure.skeleton_compressibility to its default");
}

TEST(Fault, PoresClosedByPressureAreNotAttributedToHeat) {
  Simulation<2> simulation(lamplugh());
  simulation.particles().porosity(17) = physics::smallest_porosity;
  simulation.particles().velocity(simulation.particles().size() - 1, 0) = std::numeric_limits<double>::quiet_NaN();
  expect_in(failure_of(simulation, 2), "half of time.step");
}

TEST(Fault, LeavingTheDomainNamesTheParticle) {
  Simulation<2> simulation(lamplugh({"body.slide.velocity=[0.0,300.0]"}));
  const std::string message = failure_of(simulation, 200);
  expect_in(message, "particle ");
  expect_in(message, "domain");
  expect_in(message, "[grid] min and max");
}

TEST(Fault, InvertedVolumeNamesTheParticle) {
  Simulation<2> simulation(lamplugh({"guards.energy_growth=inf"}));
  for (std::size_t p = 0; p < simulation.particles().size(); p += 2) {
    simulation.particles().velocity(p, 0) = 3000.0;
    simulation.particles().velocity(p + 1, 0) = -3000.0;
  }
  const std::string message = failure_of(simulation, 3);
  expect_in(message, "volume");
}

std::string refusal_of(const Sets& sets) {
  return error_of([&] { Simulation<2>(lamplugh(sets)); });
}

TEST(TimeStep, AboveTheLimitIsAnErrorThatStatesIt) {
  const std::string message = refusal_of("time.step=0.05; material.rock_ice.viscosity_time=0");
  expect_in(message, "time.step is 0.05 s, above the limit of 0.0");
  expect_in(message, "elastic wave of material 'rock_ice'");
  expect_in(message, "adaptive");
}

TEST(TimeStep, ViscosityIsNamedIfItSetsTheLimit) {
  const std::string message = refusal_of("material.rock_ice.viscosity_time=0.2");
  expect_in(message, "set by the viscosity of material 'rock_ice' (viscosity_time 0.2 s, at a wave speed of ");
}

TEST(TimeStep, AdaptiveStaysWithinTheLimit) {
  Simulation<2> simulation(lamplugh({"time.stepping=adaptive"}));
  for (int k = 0; k < 20; ++k) {
    simulation.step(simulation.next_step(200.0));
    EXPECT_LE(simulation.last_step(), simulation.step_limit().step);
  }
}

TEST(Lamplugh, WithoutPorePressureItDoesNotStart) {
  Simulation<2> simulation(lamplugh({"pressure.enabled=false"}));
  run_until(simulation, 5.0);
  EXPECT_LT(value_of(history_row(simulation), "mean_velocity_m_s"), 0.05);
}

}  // namespace
}  // namespace thawslide::sim
