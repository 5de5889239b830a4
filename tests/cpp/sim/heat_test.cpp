// Heat and pore pressure on the grid, compared with exact solutions.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/base_cases.hpp"
#include "base/error.hpp"
#include "base/portability.hpp"
#include "physics/pressurization.hpp"
#include "sim/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

// A bar at rest; cells and step are set by --set.
const Variant bar{"bar", "heat.boundary.x_min={temperature=8}"};

// Root mean square error against 2 + 6 erfc(x/sqrt(4 a t)).
double conduction_error(double cell) {
  const config::Case parameters =
      paper_case(bar, {fmt::format("grid.cell={}", cell), fmt::format("time.step={}", 1000.0 * cell * cell / 0.01)});
  Simulation<2> simulation(parameters);
  run_until(simulation, parameters.time.end);
  const auto& particles = simulation.particles();
  const auto& phases = simulation.model().motion.phases;
  const double diffusivity = physics::conductivity(phases, 0.375, 1.0) / physics::heat_capacity(phases, 0.375, 1.0);
  double sum = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double exact = 2.0 + 6.0 * std::erfc(particles.position(p, 0) / std::sqrt(4.0 * diffusivity * 4.0e5));
    sum += std::pow(particles.temperature(p) - exact, 2);
  }
  EXPECT_NEAR(value_of(history_row(simulation), "thermal_residual_J"), 0.0, 1e-3);
  return std::sqrt(sum / static_cast<double>(particles.size()));
}

TEST(Conduction, HalfSpaceConvergesAtSecondOrder) {
  const double coarse = conduction_error(0.2);
  const double middle = conduction_error(0.1);
  const double fine = conduction_error(0.05);
  EXPECT_LT(fine, 0.01);
  EXPECT_GT(std::log2(coarse / middle), 1.6);
  EXPECT_GT(std::log2(middle / fine), 1.6);
}

TEST(Conduction, FluxAddsItsHeat) {
  Simulation<2> simulation(paper_case(bar, "heat.boundary.x_min={flux=2}"));
  run_until(simulation, 4.0e5);
  const auto row = history_row(simulation);
  // 2 W/m2 over 0.4 m for 4e5 s.
  EXPECT_NEAR(value_of(row, "boundary_heat_J"), 2.0 * 0.4 * 4.0e5, 1e-4);
  EXPECT_NEAR(value_of(row, "thermal_residual_J"), 0.0, 1e-3);
}

TEST(Conduction, BandScalingRefinesTheGrid) {
  // With xi = 10, cells of 0.1 m conduct like cells of 0.01 m: the same curve over x/xi, 100 times earlier.
  const config::Case plain = paper_case(bar, {"time.step=1000.0"});
  const config::Case scaled = paper_case(bar, {"time.step=10.0", "time.end=4000.0", "band.thickness=0.01"});
  Simulation<2> slow(plain), fast(scaled);
  run_until(slow, plain.time.end);
  run_until(fast, scaled.time.end);
  for (std::size_t p = 0; p < slow.particles().size(); ++p) {
    EXPECT_NEAR(slow.particles().temperature(p), fast.particles().temperature(p), 1e-9);
  }
}

TEST(Conduction, StepAboveTheLimitOfALaterThinnerBandIsRefused) {
  EXPECT_THROW(
      (Simulation<2>(paper_case(bar, {"band.thickness={time=[0.0,1e5],value=[0.1,0.001]}", "time.step=500.0"}))),
      UserError);
}

TEST(UndrainedHeating, RaisesThePressureByLambda) {
  const Sets heated =
      "case.gravity=9.81; time.end=2e4; time.step=100; grid.max=[1,0.4]; material.bar.hydraulic_conductivity=2e-8; "
      "body.bar.max=[1,0.4]; body.bar.temperature=1; pressure.enabled=true; pressure.seepage=false; "
      "heat.boundary.x_min={flux=40}";
  Simulation<2> simulation(published_case("bar", heated));
  const auto& particles = simulation.particles();
  std::vector<double> start(particles.size());
  for (std::size_t p = 0; p < particles.size(); ++p) {
    start[static_cast<std::size_t>(particles.id(p))] = particles.liquid_pressure(p);
  }
  run_until(simulation, 2.0e4);
  const double lambda = physics::undrained_pressure_coefficient(simulation.model().motion.phases, 0.375, 1.0);
  double warmest = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double rise = particles.liquid_pressure(p) - start[static_cast<std::size_t>(particles.id(p))];
    const double heating = particles.temperature(p) - 1.0;
    warmest = std::max(warmest, heating);
    EXPECT_NEAR(rise, lambda * heating, 1e-3 * lambda * heating + 1e-6);
  }
  EXPECT_GT(warmest, 0.5);
}

}  // namespace
}  // namespace thawslide::sim
