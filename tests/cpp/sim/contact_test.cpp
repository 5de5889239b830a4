// Contact with the ground: effects of walls, impulses, and settling.
#include <gtest/gtest.h>

#include <algorithm>

#include "../support/base_cases.hpp"
#include "../support/fields.hpp"
#include "sim/records/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

// A block on flat ground against a roller: the node shared by wall and ground keeps the boundary condition of the wall.
const Variant cornered{
    "block",
    "case.gravity_tilt=-20; time.end=2; grid.min=[0,-10]; grid.max=[100,60]; grid.boundary.x_min=roller; "
    "basal.friction_angle=5; heat.enabled=true; pressure.enabled=true"};

// The momentum of the block equals its initial momentum plus the impulses of gravity, ground and wall, to round-off.
TEST(Budget, OfMomentumCloses) {
  Simulation<2> simulation(paper_case(cornered, "body.block.velocity=[-5,0]; mechanics.mass_damping=0.1"));
  run_until(simulation, 0.1);
  const auto row = history_row(simulation);
  for (const std::string axis : {"x", "y"}) {
    const double given = std::abs(value_of(row, "gravity_impulse_y_N_s"));
    EXPECT_LT(std::abs(value_of(row, "momentum_residual_" + axis + "_N_s")), 1e-11 * given);
    EXPECT_GT(std::abs(value_of(row, "momentum_" + axis + "_N_s")), 1e-2 * given);
    EXPECT_GT(std::abs(value_of(row, "ground_impulse_" + axis + "_N_s")), 1e-2 * given);
  }
  EXPECT_GT(std::abs(value_of(row, "constraint_impulse_x_N_s")),
            1e-2 * std::abs(value_of(row, "gravity_impulse_y_N_s")));
  EXPECT_EQ(value_of(row, "mass_residual_kg"), 0.0);
}

TEST(Walls, ApplyWhereTheyMeetTheGround) {
  Simulation<2> simulation(paper_case(cornered));
  run_until(simulation, 2.0);
  const auto row = history_row(simulation);
  EXPECT_LT(value_of(row, "mean_velocity_m_s"), 0.02);
  EXPECT_GT(value_of(row, "constraint_impulse_x_N_s"), 0.0);
  for (std::size_t p = 0; p < simulation.particles().size(); ++p) {
    EXPECT_GT(simulation.particles().position(p, 0), 0.0);
  }
}

const Sets settled = "mechanics.initial_stress=settle; mechanics.settle_damping=5";

TEST(Settling, ChangesStressOnly) {
  const config::Case parameters = paper_case(cornered + settled, "case.gravity_tilt=0; mechanics.settle_time=2");
  Simulation<2> seeded(parameters), settled(parameters);
  ASSERT_TRUE(settled.needs_settling());
  settled.settle();
  EXPECT_EQ(settled.time(), 0.0);
  EXPECT_EQ(settled.step_number(), 0);
  auto before = fields_by_id(seeded.particles()), after = fields_by_id(settled.particles());
  EXPECT_LT(*std::min_element(after["stress"].begin(), after["stress"].end()), -1e5);
  before.erase("stress");
  after.erase("stress");
  for (const auto& [name, values] : before) {
    EXPECT_EQ(after.at(name), values) << name;
  }
}

}  // namespace
}  // namespace thawslide::sim
