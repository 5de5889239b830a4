// Options of the model, each tested by its effect on a run.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/base_cases.hpp"
#include "../support/fields.hpp"
#include "base/portability.hpp"
#include "sim/records/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

const Variant block{
    "block",
    "time.step=0.002; grid.cell=10; grid.min=[-50,-150]; grid.max=[300,150]; body.block.max=[100,50]; "
    "body.block.temperature=-0.2; body.block.porosity=0.375; band.thickness=0.05; mechanisms.pressurization=true; "
    "heat.enabled=true; pressure.enabled=true"};

TEST(FrozenPressure, FollowsTheClapeyronEquation) {
  const Simulation<2> simulation(paper_case(block));
  const auto& particles = simulation.particles();
  const double logarithm = 1000.0 * 333.5e3 * std::log((273.15 - 0.2) / 273.15);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double from_ice = particles.ice_pressure(p) / 0.917;
    EXPECT_NEAR(particles.liquid_pressure(p) - from_ice, logarithm, 1e-6 * std::abs(logarithm));
  }
}

TEST(Switch, ThicknessAlongTheNormalOrVertical) {
  const Variant tilted = block +
                         "terrain.type=plane; terrain.slope=30; body.block.shape=polygon; "
                         "body.block.vertices=[[0,0],[100,-57.735],[100,-7.735],[0,50]]";
  const Simulation<2> along(paper_case(tilted)), upright(paper_case(tilted, "pressure.thickness_direction=vertical"));
  const double cosine = std::cos(pi / 6.0);
  for (std::size_t p = 0; p < along.particles().size(); ++p) {
    EXPECT_NEAR(along.particles().flow_depth(p) / upright.particles().flow_depth(p), cosine, 1e-12);
  }
}

TEST(Switch, ThicknessFollowsTheSlideOrIsFrozen) {
  for (const bool frozen : {false, true}) {
    Simulation<2> simulation(
        paper_case(block + "body.block.velocity=[20,0]", frozen ? "pressure.thickness_update=frozen" : ""));
    const auto start = fields_by_id(simulation.particles()).at("flow_depth");
    run_until(simulation, 0.5);
    EXPECT_EQ(fields_by_id(simulation.particles()).at("flow_depth") == start, frozen);
  }
}

TEST(Switch, BandScalingOfAllParticlesOrOfTheFirstLayer) {
  for (const bool first : {false, true}) {
    const Simulation<2> simulation(paper_case(block, first ? "band.region=first_layer" : ""));
    const auto& particles = simulation.particles();
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const bool scaled = !first || particles.position(p, 1) - 150.0 < 10.0;
      EXPECT_DOUBLE_EQ(particles.thermal_scaling(p), scaled ? 200.0 : 1.0);
    }
  }
}

// Traction along the base over its length, with a pore pressure far above the overburden.
double traction_under_pressure(const Sets& more) {
  const Sets sets =
      "body.block.temperature=5; body.block.velocity=[5,0]; basal.cohesion=5e4; basal.cohesion_law=constant; "
      "heat.enabled=false; pressure.seepage=false";
  Simulation<2> simulation(paper_case(block, sets + more));
  for (std::size_t p = 0; p < simulation.particles().size(); ++p) {
    simulation.particles().liquid_pressure(p) = simulation.particles().pore_pressure(p) = 5e6;
  }
  double force = 0.0;
  for (int k = 0; k < 100; ++k) {
    simulation.step(0.002);
    force += simulation.contact().force[0] / 100.0;
  }
  return force / 100.0;
}

TEST(Switch, LocationOfThePressureClamp) {
  EXPECT_NEAR(traction_under_pressure({}) / 5e4, 1.0, 0.02);
  EXPECT_NEAR(traction_under_pressure({"basal.clamp=joint"}), 0.0, 1.0);
  EXPECT_NEAR(traction_under_pressure("basal.clamp=joint; basal.cap_pressure=true") / 5e4, 1.0, 0.02);
  EXPECT_NEAR(traction_under_pressure({"mechanisms.pressurization=false"}) /
                  (5e4 + std::tan(20.0 * pi / 180.0) * 2093.75 * 9.81 * 50.0),
              1.0, 0.02);
}

// A thickening band drains more slowly, with heat on or off.
TEST(Switch, TheBandFollowsItsTableWithoutHeat) {
  Simulation<2> simulation(
      paper_case(block,
                 "heat.enabled=false; "
                 "band.thickness={ time = [0.0, 0.5, 0.5, 1.0], value = [0.05, 0.05, 0.5, 0.5] }"));
  run_until(simulation, 0.4);
  EXPECT_DOUBLE_EQ(simulation.particles().thermal_scaling(0), 200.0);
  run_until(simulation, 0.6);
  EXPECT_DOUBLE_EQ(simulation.particles().thermal_scaling(0), 20.0);
}

}  // namespace
}  // namespace thawslide::sim
