// Contact between bodies on cells that follow the ground: relatives of between_bodies_test.cpp on planes, and on uneven
// ground in 3D.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/body_motion.hpp"
#include "../support/following_plane.hpp"
#include "../support/reproducible_runs.hpp"
#include "../support/slide_on_dem.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

constexpr double cell = 2.0, spacing = 0.5 * cell;  // of particles [m]
constexpr double dt = 0.001, gravity = 9.81;

std::string text_of(const Place& vector) { return fmt::format("[{},{}]", vector[0], vector[1]); }

// Block on a plane: extent along x and heights along the vertical above the plane [m]. Its ends are vertical, or across
// the plane.
struct Block {
  double from, to, bottom, top;
  bool has_vertical_ends = true;

  [[nodiscard]] std::vector<Place> vertices(const Incline& plane) const {
    const auto above = [&](double x, double height) {
      const double along = x / std::cos(plane.angle());
      return has_vertical_ends ? Place(plane.place(along, 0.0) + Place(0.0, height))
                               : plane.place(along, height * std::cos(plane.angle()));
    };
    return {above(from, bottom), above(to, bottom), above(to, top), above(from, top)};
  }
};

// Two elastic blocks on a plane without friction, with velocities down it.
config::Case two_blocks(const Incline& plane, const Block& first, double speed, const Block& second, double other_speed,
                        const Sets& sets = {}) {
  std::string vertices;
  for (const Place& vertex : second.vertices(plane)) {
    vertices += (vertices.empty() ? "" : ",") + text_of(vertex);
  }
  return body_on_plane(
      plane, cell, first.vertices(plane),
      Sets{fmt::format("time.stepping=fixed; time.step={}; contact.between_bodies=frictional", dt),
           "contact.friction_angle=0; basal.friction_angle=0; material.rock.law=elastic; material.rock.cohesion=",
           "material.rock.friction_angle=; material.rock.youngs_modulus=1e8; material.rock.viscosity_time=0.005",
           "body.right.shape=polygon; body.right.material=rock; body.right.temperature=-5; body.right.porosity=0.3",
           fmt::format("body.right.vertices=[{}]", vertices), "body.block.velocity=" + text_of(speed * plane.down()),
           "body.right.velocity=" + text_of(other_speed * plane.down())} +
          sets);
}

// Only gravity changes the total momentum down the plane. On the steeper plane, the second block is lifted and tilts.
TEST(FollowingBodies, CollideAfterTheGapHasClosed) {
  constexpr double speed = 5.0, gap = 2.0;
  for (const double slope : {0.0, 30.0, 55.0}) {
    const Incline plane{slope};
    Simulation<2> simulation(two_blocks(plane, {0, 12, 0, 8}, speed, {12 + gap, 24 + gap, 0, 8}, 0.0));
    double met = HUGE_VAL, smallest_gap = gap;
    while (simulation.time() < met + 0.3) {
      simulation.step(dt);
      ASSERT_LT(simulation.time(), 2.0);
      const BodyMotion left(simulation, 0), right(simulation, 1);
      const double left_speed = left.velocity.dot(plane.down()), right_speed = right.velocity.dot(plane.down());
      const double fall = gravity * std::sin(plane.angle()) * simulation.time();
      const double momentum = left.mass * speed + (left.mass + right.mass) * fall;
      ASSERT_NEAR(left.mass * left_speed + right.mass * right_speed, momentum, 1e-11 * momentum);
      smallest_gap = std::min(smallest_gap, gap_along_x(simulation, spacing));
      if (met == HUGE_VAL && std::abs(right_speed - fall) > 1e-6 * speed) {
        met = simulation.time();
        EXPECT_NEAR(smallest_gap, 0.0, (speed + fall) * dt) << "it moves before the gap is closed";
      }
    }
    EXPECT_GT(smallest_gap, -0.1 * cell) << "they run into one another";
    const double left = BodyMotion(simulation, 0).velocity[0], right = BodyMotion(simulation, 1).velocity[0];
    EXPECT_TRUE(slope > 30.0 || right > left) << left << " and " << right << " m/s";
  }
}

TEST(FollowingBodies, SeparateWithoutDrag) {
  constexpr double speed = 2.0;
  const Incline plane{30.0};
  for (const double gap : {0.0, 0.6}) {
    Simulation<2> simulation(two_blocks(plane, {0, 12, 0, 8}, 0.0, {12 + gap, 24 + gap, 0, 8}, speed));
    const double bound = gap > 0.0 ? 1e-7 : 1e-3 * speed;
    double difference = 0.0;
    while (simulation.time() < 0.5) {
      simulation.step(dt);
      const double fall = gravity * std::sin(plane.angle()) * simulation.time();
      difference = std::max({difference, std::abs(BodyMotion(simulation, 0).velocity.dot(plane.down()) - fall),
                             std::abs(BodyMotion(simulation, 1).velocity.dot(plane.down()) - speed - fall)});
    }
    EXPECT_LT(difference, bound) << "a gap of " << gap << " m";
  }
}

TEST(FollowingBodies, FallFreelyOntoOthers) {
  for (const double slope : {30.0, 55.0}) {
    const Incline plane{slope};
    Simulation<2> simulation(
        two_blocks(plane, {-40, 60, 0, 4}, 0.0, {-10, 6, 4.7, 8.7}, 0.0, "basal.friction_angle=80"));
    while (std::abs(BodyMotion(simulation, 1).velocity[1] + gravity * simulation.time()) < 1e-6) {
      simulation.step(dt);
      ASSERT_LT(simulation.time(), 1.0);
    }
    const Place above_plane(std::tan(plane.angle()), 1.0);
    const double gap =
        extent_of<2>(simulation, 1, above_plane).first - extent_of<2>(simulation, 0, above_plane).second - spacing;
    EXPECT_NEAR(gap, 0.0, -BodyMotion(simulation, 1).velocity[1] * dt);
  }
}

// Acceleration of a block that slides on a long one, which is fixed on rough ground, down the plane [m/s2].
double acceleration(const Incline& plane, Block sliding, double friction_angle) {
  Simulation<2> simulation(
      two_blocks(plane, {-40, 60, 0, 4}, 0.0, sliding, 9.0,
                 {fmt::format("contact.friction_angle={}; basal.friction_angle=80", friction_angle),
                  "mechanics.slope_shear=true"}));
  run_until(simulation, 0.2);
  const double before = BodyMotion(simulation, 1).velocity.dot(plane.down());
  run_until(simulation, 1.2);
  return BodyMotion(simulation, 1).velocity.dot(plane.down()) - before;
}

TEST(FollowingBodies, FollowCoulombsLaw) {
  for (const bool has_vertical_ends : {true, false}) {
    for (const auto& [slope, angle] :
         {std::pair(0.0, 0.0), std::pair(0.0, 10.0), std::pair(0.0, 30.0), std::pair(30.0, 0.0), std::pair(30.0, 10.0),
          std::pair(30.0, 30.0), std::pair(30.0, 40.0), std::pair(55.0, 30.0)}) {
      const Incline plane{slope};
      const double friction = gravity * std::cos(plane.angle()) * std::tan(angle * pi / 180.0);
      const double exact = gravity * std::sin(plane.angle()) - friction;
      const double found = acceleration(plane, {-10, 6, 4, 8, has_vertical_ends}, angle);
      EXPECT_NEAR(found, exact, 0.005 + 0.02 * friction) << angle << " degrees on a slope of " << slope;
    }
  }
}

// Two releases on uneven ground. The one behind, at 15 m/s, runs into the other.
std::unique_ptr<Simulation<3>> releases_on_uneven_ground() {
  const Place half(100.0, 100.0);
  const auto uneven = [](double x, double y) {
    return -0.5 * x + 0.2 * y + 2.0 * std::sin(0.1 * x) * std::cos(0.08 * y);
  };
  const auto thickness = [&](double from, double to) {
    return thickness_between(-half, half, 2.5,
                             [=](double x, double y) { return x > from && x < to && std::abs(y) < 20.0 ? 12.0 : 0.0; });
  };
  config::Site site = site_of(raster_between(-half, half, 4.0, uneven), thickness(-50.0, -10.0));
  site.releases["front"].thickness = thickness(-5.0, 35.0);
  const auto slide = release_on_dem({20.0, 0.002, 5.0, {-100.0, -100.0, -100.0}, {100.0, 100.0, 150.0}},
                                    "material.debris.youngs_modulus=5e7; material.debris.viscosity_time=0.005", 20.0);
  return std::make_unique<Simulation<3>>(
      case_on_dem(slide, {"time.stepping=adaptive; body.slide.velocity=[15,0,-7.5]",
                          "body.front.material=debris; body.front.shape=release; body.front.temperature=-1",
                          "body.front.porosity=0.3; body.front.particles_per_axis=3",
                          "body.front.thickness={raster='" + (folder_of_this_test() / "thickness.tif").string() + "'}",
                          "contact.between_bodies=frictional; contact.friction_angle=20"}),
      site);
}

TEST(FollowingBodies, AreReproducibleAndConserveMomentumOnUnevenGround) {
  constexpr int steps = 250;
  expect_reproducible_run<3>(
      releases_on_uneven_ground, steps, {{2, 7, -1}, {3, 1, steps / 2}},
      [&](const Simulation<3>& simulation, int step) {
        const HistoryRow row = history_row(simulation);
        for (const std::string axis : {"x", "y", "z"}) {
          EXPECT_NEAR(value_of(row, "momentum_residual_" + axis + "_N_s") / (simulation.budget().initial_mass * 15.0),
                      0.0, 1e-13);
        }
        EXPECT_TRUE(step < steps ||
                    BodyMotion(simulation, 1).velocity[0] > BodyMotion(simulation, 0).velocity[0] + 5.0);
      });
}

}  // namespace
}  // namespace thawslide::sim
