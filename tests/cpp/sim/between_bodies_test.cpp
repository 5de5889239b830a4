// Bodies with separate velocity fields: onset of interaction, conservation, and bonds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/base_cases.hpp"
#include "../support/body_motion.hpp"
#include "../support/fields.hpp"
#include "../support/messages.hpp"
#include "sim/checks/body_warnings.hpp"
#include "sim/records/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

constexpr double cell = 2.0;  // m; twice the particle spacing
constexpr double dt = 0.001;

// Two blocks on level ground without friction, of the same elastic material. In 3D as wide as they are high.
template <int Dim>
config::Case two_blocks(double gap, double speed, double other_speed, const Sets& sets = {}) {
  const auto at = place_in<Dim>;
  const Sets bodies = fmt::format(
      "case.dimension={}; time.step={}; grid.cell={}; grid.min={}; grid.max={}; body.block.min={}; body.block.max={}; "
      "body.block.velocity={}; body.right.min={}; body.right.max={}; body.right.velocity={}",
      Dim, dt, cell, at(-30.0, -6.0, -4.0), at(60.0, 14.0, 20.0), at(0.0, 0.0, 0.0), at(12.0, 8.0, 8.0),
      at(speed, 0.0, 0.0), at(12.0 + gap, 0.0, 0.0), at(24.0 + gap, 8.0, 8.0), at(other_speed, 0.0, 0.0));
  return base_case("block",
                   "time.end=10; material.rock.youngs_modulus=1e8; material.rock.viscosity_time=0.005; "
                   "basal.friction_angle=0; mechanisms.pressurization=true; body.block.porosity=0.3; "
                   "body.right.material=rock; body.right.porosity=0.3" +
                       bodies + sets);
}

const Sets frictional = "contact.between_bodies=frictional; contact.friction_angle=0.0";

template <int Dim>
void expect_collision_without_action_at_a_distance() {
  constexpr double speed = 5.0, gap = 1.3;
  Simulation<Dim> simulation(two_blocks<Dim>(gap, speed, 0.0, frictional));
  const double before = BodyMotion(simulation, 0).mass * BodyMotion(simulation, 0).velocity[0];
  double smallest_gap = gap;
  bool moved = false;
  while (simulation.time() < 0.45) {
    simulation.step(dt);
    const BodyMotion left(simulation, 0), right(simulation, 1);
    const double now = gap_along_x(simulation, 0.5 * cell);
    smallest_gap = std::min(smallest_gap, now);
    ASSERT_NEAR(left.mass * left.velocity[0] + right.mass * right.velocity[0], before, 1e-11 * before);
    if (!moved && std::abs(right.velocity[0]) > 1e-9 * speed) {
      moved = true;
      EXPECT_LT(now, speed * dt * 1.01) << "it moves before the gap is closed";
    }
  }
  EXPECT_TRUE(moved);
  EXPECT_GT(smallest_gap, -0.1 * cell) << "they run into one another";
  const BodyMotion left(simulation, 0), right(simulation, 1);
  EXPECT_GE(right.velocity[0], left.velocity[0] - 1e-3 * speed);
  EXPECT_GT(right.velocity[0], 0.5 * speed);
}

TEST(BetweenBodies, InteractOnlyAfterTheGapHasClosedInThePlane) { expect_collision_without_action_at_a_distance<2>(); }
TEST(BetweenBodies, InteractOnlyAfterTheGapHasClosedInSpace) { expect_collision_without_action_at_a_distance<3>(); }

// After contact from edge to edge, the first block moves at its initial speed, and the second stays at rest.
template <int Dim>
void expect_no_drag_as_they_part(double gap) {
  constexpr double speed = 2.0;
  // Edge to edge, their weight presses them sideways against each other until they have separated.
  const double bound = gap > 0.0 ? 1e-7 : 1e-3 * speed;
  Simulation<Dim> free(two_blocks<Dim>(gap, 0.0, speed, frictional));
  Simulation<Dim> bonded(two_blocks<Dim>(gap, 0.0, speed));
  while (free.time() < 0.5) {
    free.step(dt);
    bonded.step(dt);
    ASSERT_NEAR(BodyMotion(free, 0).velocity[0], 0.0, bound);
    ASSERT_NEAR(BodyMotion(free, 1).velocity[0], speed, bound);
  }
  EXPECT_GT(BodyMotion(bonded, 0).velocity[0], 0.05 * speed) << "one velocity field drags it along";
}

TEST(BetweenBodies, SeparateWithoutDragInThePlane) {
  expect_no_drag_as_they_part<2>(0.0);
  expect_no_drag_as_they_part<2>(0.6);
}
TEST(BetweenBodies, SeparateWithoutDragInSpace) { expect_no_drag_as_they_part<3>(0.0); }

// Bonded bodies share nodes, for any default.
TEST(BetweenBodies, ShareNodesIfBonded) {
  const Sets seam = "contact_pair.seam.bodies=['block','right']; contact_pair.seam.contact=bonded";
  Simulation<2> bonded(two_blocks<2>(0.0, 0.0, 1.0, frictional + seam)), one(two_blocks<2>(0.0, 0.0, 1.0));
  for (int k = 0; k < 100; ++k) {
    bonded.step(dt);
    one.step(dt);
  }
  expect_the_same_state(state_of(one), state_of(bonded), "after 100 steps");
}

// The residual of the energy budget is the error of time integration, which decreases with the step.
TEST(BetweenBodies, CloseTheirBudgets) {
  const auto residual_after_impact = [](double step) {
    Simulation<2> simulation(two_blocks<2>(0.5, 6.0, -1.0, frictional + fmt::format("time.step={}", step)));
    run_until(simulation, 0.5);
    const auto row = history_row(simulation);
    EXPECT_GT(value_of(row, "contact_loss_J"), 0.0);
    return value_of(row, "mechanical_residual_J");
  };
  const double coarse = residual_after_impact(dt), fine = residual_after_impact(0.25 * dt);
  EXPECT_NEAR(fine / coarse, 0.25, 0.05);
}

TEST(BetweenBodies, CauseAWarningIfTheyShareNodesAcrossAGap) {
  const auto warning = [](double gap, const Sets& sets) {
    return warning_of_bodies_apart(Simulation<2>(two_blocks<2>(gap, 0.0, 0.0, sets)));
  };
  EXPECT_EQ(warning(0.0, {}), "") << "they touch";
  EXPECT_EQ(warning(10.0, frictional), "");
  EXPECT_EQ(warning(10.0, {"contact.between_bodies=bonded"}), "") << "it is meant";
  expect_in(warning(10.0, {}),
            "body.right stands apart from body.block, and contact.between_bodies is \"bonded\": "
            "below a gap of 1 to 2 cells (2 to 4 m) they interact");
}

}  // namespace
}  // namespace thawslide::sim
