// Bodies with separate velocity fields: onset of interaction, conservation, and bonds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "../support/base_cases.hpp"
#include "../support/fields.hpp"
#include "../support/messages.hpp"
#include "base/portability.hpp"
#include "sim/checks/bodies_apart.hpp"
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
  const auto at = [](double x, double y, double z) {
    return Dim == 2 ? fmt::format("[{}, {}]", x, z) : fmt::format("[{}, {}, {}]", x, y, z);
  };
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

// Motion of one body.
struct Motion {
  double mass = 0.0, speed = 0.0, rise = 0.0;  // means along x and upwards [m/s]
  double first = std::numeric_limits<double>::max(), last = std::numeric_limits<double>::lowest();  // along x [m]
};

template <int Dim>
Motion motion_of(const Simulation<Dim>& simulation, int body) {
  Motion motion;
  const auto& particles = simulation.particles();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (particles.body(p) == body) {
      motion.mass += particles.mass(p);
      motion.speed += particles.mass(p) * particles.velocity(p, 0);
      motion.rise += particles.mass(p) * particles.velocity(p, Dim - 1);
      motion.first = std::min(motion.first, particles.position(p, 0));
      motion.last = std::max(motion.last, particles.position(p, 0));
    }
  }
  motion.speed /= motion.mass;
  motion.rise /= motion.mass;
  return motion;
}

// Gap between the edges of the particles [m].
template <int Dim>
double gap_between(const Simulation<Dim>& simulation) {
  return motion_of(simulation, 1).first - motion_of(simulation, 0).last - 0.5 * cell;
}

template <int Dim>
void expect_collision_without_action_at_a_distance() {
  constexpr double speed = 5.0, gap = 1.3;
  Simulation<Dim> simulation(two_blocks<Dim>(gap, speed, 0.0, frictional));
  const double before = motion_of(simulation, 0).mass * motion_of(simulation, 0).speed;
  double smallest_gap = gap;
  bool moved = false;
  while (simulation.time() < 0.45) {
    simulation.step(dt);
    const Motion left = motion_of(simulation, 0), right = motion_of(simulation, 1);
    const double now = gap_between(simulation);
    smallest_gap = std::min(smallest_gap, now);
    ASSERT_NEAR(left.mass * left.speed + right.mass * right.speed, before, 1e-11 * before);
    if (!moved && std::abs(right.speed) > 1e-9 * speed) {
      moved = true;
      EXPECT_LT(now, speed * dt * 1.01) << "it moves before the gap is closed";
    }
  }
  EXPECT_TRUE(moved);
  EXPECT_GT(smallest_gap, -0.1 * cell) << "they run into one another";
  const Motion left = motion_of(simulation, 0), right = motion_of(simulation, 1);
  EXPECT_GE(right.speed, left.speed - 1e-3 * speed);
  EXPECT_GT(right.speed, 0.5 * speed);
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
    ASSERT_NEAR(motion_of(free, 0).speed, 0.0, bound);
    ASSERT_NEAR(motion_of(free, 1).speed, speed, bound);
  }
  EXPECT_GT(motion_of(bonded, 0).speed, 0.05 * speed) << "one velocity field drags it along";
}

TEST(BetweenBodies, SeparateWithoutDragInThePlane) {
  expect_no_drag_as_they_part<2>(0.0);
  expect_no_drag_as_they_part<2>(0.6);
}
TEST(BetweenBodies, SeparateWithoutDragInSpace) { expect_no_drag_as_they_part<3>(0.0); }

// Bodies that never meet have bitwise identical motion, whether they share nodes or not.
TEST(BetweenBodies, DoNotInteractFarApart) {
  Simulation<2> shared(two_blocks<2>(20.0, -1.0, 1.0)), own(two_blocks<2>(20.0, -1.0, 1.0, frictional));
  for (int k = 0; k < 200; ++k) {
    shared.step(dt);
    own.step(dt);
  }
  expect_the_same_state(fields_by_id(shared.particles()), fields_by_id(own.particles()), "after 200 steps");
}

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

// The upper block slides on a long lower one, which is fixed on rough ground: friction decelerates it by g tan(phi) and
// holds it below that angle.
double slowing(double friction_angle, double speed) {
  const config::Case parameters =
      two_blocks<2>(0.0, 0.0, speed,
                    {"contact.between_bodies=frictional", fmt::format("contact.friction_angle={}", friction_angle),
                     "body.block.min=[-20.0, 0.0]", "body.block.max=[40.0, 4.0]", "body.right.min=[-10.0, 4.0]",
                     "body.right.max=[6.0, 8.0]", "basal.friction_angle=60.0"});
  Simulation<2> simulation(parameters);
  run_until(simulation, 0.2);
  const double before = motion_of(simulation, 1).speed;
  run_until(simulation, 1.2);
  return before - motion_of(simulation, 1).speed;
}

TEST(BetweenBodies, FollowCoulombsLaw) {
  for (const double angle : {10.0, 30.0}) {
    const double exact = 9.81 * std::tan(angle * pi / 180.0);
    EXPECT_NEAR(slowing(angle, 9.0), exact, 0.05 * exact) << angle << " degrees";
  }
  EXPECT_NEAR(slowing(0.0, 5.0), 0.0, 0.02) << "no friction";
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
