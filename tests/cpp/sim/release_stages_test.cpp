// Release in stages: a body is held until its release time, and then moves as it would from the start of a run.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/base_cases.hpp"
#include "../support/body_motion.hpp"
#include "../support/fields.hpp"
#include "../support/messages.hpp"
#include "../support/reproducible_runs.hpp"
#include "../support/slide_on_dem.hpp"
#include "sim/records/history.hpp"
#include "sim/records/run_records.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

constexpr double dt = 0.001, gravity = 9.81, tilt = 30.0, friction_angle = 20.0;
constexpr double release_time = 0.5;

// Two elastic blocks on a frictional incline that falls towards +x, the second one downhill of the first.
template <int Dim>
config::Case two_blocks(double gap, const Sets& sets = {}) {
  const auto at = place_in<Dim>;
  return base_case(
      "block",
      Sets(fmt::format("case.dimension={}; case.gravity_tilt={}; time.end=10; time.step={}; grid.cell=2; "
                       "grid.min={}; grid.max={}; body.block.min={}; body.block.max={}; body.right.min={}; "
                       "body.right.max={}; body.right.material=rock; body.right.porosity=0.3; "
                       "body.block.porosity=0.3; material.rock.youngs_modulus=1e8; "
                       "material.rock.viscosity_time=0.005; material.rock.poisson_ratio=0; "
                       "mechanics.slope_shear=true; basal.friction_angle={}",
                       Dim, tilt, dt, at(-30.0, -6.0, -4.0), at(90.0, 14.0, 20.0), at(0.0, 0.0, 0.0),
                       at(12.0, 8.0, 4.0), at(12.0 + gap, 0.0, 0.0), at(24.0 + gap, 8.0, 4.0), friction_angle)) +
          sets);
}

const Sets first_held = fmt::format("body.block.release_time={}", release_time);
const Sets second_held = fmt::format("body.right.release_time={}", release_time);
const Sets frictional = "contact.between_bodies=frictional; contact.friction_angle=0";

// Acceleration of a sliding block [m/s2].
double acceleration() {
  const double angle = tilt * pi / 180.0;
  return gravity * (std::sin(angle) - std::tan(friction_angle * pi / 180.0) * std::cos(angle));
}

template <int Dim>
void expect_balanced(const Simulation<Dim>& simulation) {
  const HistoryRow row = history_row(simulation);
  const double mass = simulation.budget().initial_mass;
  const double impulse = mass * gravity * std::max(simulation.time(), dt);
  EXPECT_EQ(value_of(row, "mass_residual_kg"), 0.0);
  for (const std::string axis : Dim == 2 ? std::vector{"x", "y"} : std::vector{"x", "y", "z"}) {
    EXPECT_NEAR(value_of(row, "momentum_residual_" + axis + "_N_s") / impulse, 0.0, 1e-12) << axis;
  }
}

// Each block slides by a t^2/2 from its own release. The held one does not move at all. energy: largest residual of the
// mechanical energy over the friction work.
template <int Dim>
void expect_motion_of_sliding_blocks(const Sets& sets, double energy = 1e-3) {
  constexpr double end = 1.5;
  const config::Case parameters = two_blocks<Dim>(10.0, sets);
  Simulation<Dim> simulation(parameters);
  while (simulation.time() < end - 0.5 * dt) {
    if (std::abs(simulation.time() - 0.4) < 0.5 * dt) {
      const BodyMotion held(simulation, 0), moving(simulation, 1);
      EXPECT_EQ(held.farthest, 0.0);
      EXPECT_EQ(held.velocity[0], 0.0);
      EXPECT_NEAR(moving.displacement[0], 0.5 * acceleration() * 0.4 * 0.4, 2e-3 * moving.displacement[0]);
      EXPECT_TRUE(simulation.is_held(0));
      expect_balanced(simulation);
    }
    simulation.step(simulation.next_step(end));
  }
  EXPECT_FALSE(simulation.is_held(0));
  for (const int body : {0, 1}) {
    const double since = end - (body == 0 ? release_time : 0.0);
    const BodyMotion motion(simulation, body);
    EXPECT_NEAR(motion.displacement[0], 0.5 * acceleration() * since * since, 1e-3 * motion.displacement[0]) << body;
    EXPECT_NEAR(motion.velocity[0], acceleration() * since, 1e-3 * motion.velocity[0]) << body;
  }
  expect_balanced(simulation);
  const HistoryRow row = history_row(simulation);
  EXPECT_NEAR(value_of(row, "mechanical_residual_J") / value_of(row, "friction_work_J"), 0.0, energy);
}

TEST(ReleaseStages, AreFollowedByTheMotionOfASlidingBlockInThePlane) { expect_motion_of_sliding_blocks<2>(first_held); }
TEST(ReleaseStages, AreFollowedByTheMotionOfASlidingBlockInSpace) { expect_motion_of_sliding_blocks<3>(first_held); }
TEST(ReleaseStages, BeginAtTheirTimeWithAdaptiveSteps) {
  // Measured: 0.005, with APIC and with steps longer than the fixed ones.
  expect_motion_of_sliding_blocks<2>(first_held + Sets("time.step=; time.stepping=adaptive; mechanics.transfer=apic"),
                                     0.01);
}

// A block that is released later has bitwise the same motion as one that is released at the start, but for its place in
// time. Its stress is that at t = 0 until then.
TEST(ReleaseStages, ChangeNothingButTheTime) {
  const config::Case parameters = two_blocks<2>(20.0, first_held);
  Simulation<2> staged(parameters), at_once(two_blocks<2>(20.0));
  const auto of_first = [](const Simulation<2>& simulation) {
    auto fields = fields_by_id(simulation.particles());
    for (auto& [name, values] : fields) {
      const std::size_t components = values.size() / simulation.particles().size();
      std::vector<double> of_body;
      const std::vector<double> bodies = fields_by_id(simulation.particles()).at("body");
      for (std::size_t p = 0; p < bodies.size(); ++p) {
        for (std::size_t c = 0; c < components && bodies[p] == 0.0; ++c) {
          of_body.push_back(values[p * components + c]);
        }
      }
      values = of_body;
    }
    return fields;
  };
  const auto at_start = of_first(staged);
  for (int k = 0; k < 500; ++k) {
    staged.step(dt);
  }
  for (const auto& [name, values] : of_first(staged)) {
    EXPECT_EQ(values, at_start.at(name)) << name;
  }
  for (int k = 0; k < 300; ++k) {
    staged.step(dt);
    at_once.step(dt);
  }
  expect_the_same_state(of_first(at_once), of_first(staged), "300 steps after the release");
}

// All energies are constant while everything is held; the ground carries the weight.
TEST(ReleaseStages, HoldWithoutWork) {
  Simulation<2> simulation(two_blocks<2>(0.0, first_held + second_held));
  const HistoryRow before = history_row(simulation);
  for (int k = 0; k < 100; ++k) {
    simulation.step(dt);
  }
  const HistoryRow row = history_row(simulation);
  for (const char* column : {"kinetic_J", "strain_J", "plastic_J", "friction_work_J", "contact_loss_J", "numerical_J",
                             "viscous_J", "momentum_x_N_s", "momentum_y_N_s", "constraint_impulse_x_N_s"}) {
    EXPECT_EQ(value_of(row, column), 0.0) << column;
  }
  EXPECT_EQ(value_of(row, "potential_J"), value_of(before, "potential_J"));
  const double weight = simulation.budget().initial_mass * gravity;
  EXPECT_NEAR(value_of(row, "seismic_force_x_N") / weight, 0.0, 1e-12);
  EXPECT_NEAR(value_of(row, "seismic_force_y_N") / weight, 0.0, 1e-12);
  EXPECT_NEAR(value_of(row, "ground_impulse_y_N_s") / (weight * std::cos(tilt * pi / 180.0) * 0.1), 1.0, 1e-12);
  expect_balanced(simulation);
}

// The lower part leaves a free face: nothing pulls it back.
template <int Dim>
void expect_free_face(const Sets& sets) {
  const config::Case parameters = two_blocks<Dim>(0.0, first_held + sets);
  Simulation<Dim> simulation(parameters);
  run_until(simulation, 0.45);
  const BodyMotion held(simulation, 0), moving(simulation, 1);
  EXPECT_EQ(held.farthest, 0.0);
  EXPECT_NEAR(moving.displacement[0], 0.5 * acceleration() * 0.45 * 0.45, 0.01 * moving.displacement[0]);
  expect_balanced(simulation);
}

TEST(ReleaseStages, LeaveAFreeFace) {
  expect_free_face<2>({});
  expect_free_face<2>(frictional);
  expect_free_face<3>({});
}

// The upper part rests against the held lower one.
template <int Dim>
void expect_wall(const Sets& sets) {
  const config::Case parameters = two_blocks<Dim>(0.0, second_held + sets);
  Simulation<Dim> simulation(parameters);
  run_until(simulation, 0.45);
  const BodyMotion moving(simulation, 0), held(simulation, 1);
  EXPECT_EQ(held.farthest, 0.0);
  EXPECT_LT(moving.displacement[0], 0.01) << "m; elastic compression";
  expect_balanced(simulation);
  const HistoryRow row = history_row(simulation);
  EXPECT_NEAR(value_of(row, "mechanical_residual_J") / value_of(row, "friction_work_J"), 0.0, 0.05);
  run_until(simulation, 1.0);
  EXPECT_NEAR(BodyMotion(simulation, 0).displacement[0], 0.5 * acceleration() * 0.25, 0.02) << "both leave together";
}

TEST(ReleaseStages, HoldAWallForTheOthers) {
  expect_wall<2>({});
  expect_wall<2>(frictional);
  expect_wall<3>({});
}

// A block that slides over a held one: rough if they are bonded.
TEST(ReleaseStages, HaveTheFrictionOfTheirContact) {
  const auto speed = [](const Sets& sets) {
    const config::Case parameters =
        two_blocks<2>(0.0, Sets("body.right.min=[-10,-0]; body.right.max=[60,4]; body.block.min=[0,4]; "
                                "body.block.max=[12,8]; body.right.release_time=5; body.block.velocity=[1,0]") +
                               sets);
    Simulation<2> simulation(parameters);
    run_until(simulation, 0.5);
    EXPECT_EQ(BodyMotion(simulation, 1).farthest, 0.0);
    return BodyMotion(simulation, 0).velocity[0];
  };
  const double angle = tilt * pi / 180.0;
  EXPECT_NEAR(speed(frictional), 1.0 + 0.5 * gravity * std::sin(angle), 0.02);
  EXPECT_NEAR(speed(frictional + Sets("contact.friction_angle=20")), 1.0 + 0.5 * acceleration(), 0.05);
  EXPECT_NEAR(speed({}), 0.0, 0.2) << "it sticks";
}

// With every mechanism, on all threads and after a restart. A held body has no friction heat.
template <int Dim>
void expect_balance_of_heat(const config::Case& parameters, int held, int release_step) {
  const auto make = [&] { return std::make_unique<Simulation<Dim>>(parameters); };
  const auto visit = [&](const Simulation<Dim>& simulation, int k) {
    expect_closed_budgets(simulation);
    EXPECT_EQ(simulation.is_held(static_cast<std::size_t>(held)), k < release_step) << k;
    const auto& particles = simulation.particles();
    for (std::size_t p = 0; k == release_step && p < particles.size(); ++p) {
      ASSERT_TRUE(particles.body(p) != held || particles.slip(p) == 0.0);
    }
  };
  expect_reproducible_run<Dim>(make, 3 * release_step,
                               {{1, 0, release_step / 2}, {1, 0, release_step}, {2, 7, 2 * release_step}}, visit);
}

TEST(ReleaseStages, CloseTheBudgetsOfHeatAndWater) {
  const Sets scaled = "body.left.release_time=0.04; band.model=scaled";
  expect_balance_of_heat<2>(base_case("two_bodies", scaled), 0, 20);
  expect_balance_of_heat<2>(base_case("two_bodies", scaled + frictional), 0, 20);
}
TEST(ReleaseStages, CloseTheBudgetsOfBandColumns) {
  expect_balance_of_heat<2>(
      base_case("columns",
                "body.upper.material=rock; body.upper.min=[-50,0]; body.upper.max=[0,40]; "
                "body.upper.temperature=-1; body.upper.porosity=0.375; body.upper.release_time=0.1"),
      1, 20);
}
TEST(ReleaseStages, CloseTheBudgetsInSpace) {
  expect_balance_of_heat<3>(base_case("box",
                                      "body.lower.material=rock; body.lower.min=[6,3,0]; body.lower.max=[10,7,3]; "
                                      "body.lower.temperature=-0.5; body.lower.porosity=0.375; "
                                      "body.box.release_time=0.04; band.model=scaled"),
                            0, 20);
}

// Settling is common to all bodies; the stress that it leaves is kept until the release.
TEST(ReleaseStages, FollowTheSettling) {
  const Sets settled =
      "mechanics.initial_stress=settle; mechanics.settle_time=0.5; mechanics.settle_damping=10; mechanics.slope_shear=";
  Simulation<2> staged(two_blocks<2>(0.0, first_held + settled)), at_once(two_blocks<2>(0.0, settled));
  EXPECT_TRUE(staged.settle());
  EXPECT_TRUE(at_once.settle());
  const auto stress = fields_by_id(at_once.particles()).at("stress");
  EXPECT_EQ(fields_by_id(staged.particles()).at("stress"), stress);
  for (int k = 0; k < 200; ++k) {
    staged.step(dt);
  }
  const auto bodies = fields_by_id(staged.particles()).at("body"), now = fields_by_id(staged.particles()).at("stress");
  const std::size_t components = now.size() / bodies.size();
  for (std::size_t k = 0; k < now.size(); ++k) {
    ASSERT_TRUE(bodies[k / components] != 0.0 || now[k] == stress[k]);
  }
}

// Front and runout before the release are those of the other bodies, and a run does not end at rest before it.
TEST(ReleaseStages, CountForTheFrontFromTheReleaseOn) {
  Simulation<2> simulation(two_blocks<2>(20.0, second_held));
  EXPECT_NEAR(value_of(history_row(simulation), "front_position_m"), 12.0, 0.6);
  EXPECT_FALSE(simulation.moved_mass().has(1));
  EXPECT_FALSE(simulation.moved_mass().has_moved);
  run_until(simulation, 0.4);
  EXPECT_LT(value_of(history_row(simulation), "front_position_m"), 13.0);
  run_until(simulation, 0.6);
  EXPECT_TRUE(simulation.moved_mass().has(1));
}

TEST(ReleaseStages, DelayTheEndAtRest) {
  const Sets stops =
      "time.stop_at_rest=0.05; time.rest_time=0.1; time.moved_distance=0.01; basal.friction_angle=50; "
      "body.right.velocity=[1,0]; body.block.release_time=2";
  Simulation<2> simulation(two_blocks<2>(20.0, stops));
  while (!simulation.ends_at_rest() && simulation.time() < 5.0) {
    simulation.step(simulation.next_step(5.0));
  }
  EXPECT_GE(simulation.time(), 2.1 - 0.5 * dt);
  EXPECT_LT(simulation.time(), 2.3);
  expect_in(simulation.rest_rule(), "after the last scheduled change at 2 s");
}

// A release over uneven ground stays exactly in place, by a number or by the time of its polygons.
TEST(ReleaseStages, HoldAReleaseOnADem) {
  const auto bend = [](double x, double /*y*/) { return x < 0.0 ? -0.7 * x : 0.02 * x * x; };
  const auto polygons = folder_of_this_test() / "polygons.geojson";
  std::ofstream(polygons).close();
  const Sets by_attribute{"body.slide.release_time={ attribute = 'from' }",
                          fmt::format("body.slide.release='{}'", polygons.string())};
  for (const Sets& sets : {Sets("body.slide.release_time=0.2"), by_attribute}) {
    const config::Case parameters = case_on_dem(
        release_on_dem({5.0, 0.002, 5.0, {-100, -60, -100}, {100, 60, 200}}, elastic_rock(0.01), 10.0), sets);
    config::Site site = site_of(raster_between({-120, -80}, {120, 80}, 5.0, bend),
                                thickness_between({-50, -20}, {10, 20}, 5.0, [](double, double) { return 12.0; }));
    site.releases["slide"].release_time = 0.2;
    Simulation<3> simulation(parameters, site);
    run_until(simulation, 0.199);
    EXPECT_EQ(BodyMotion(simulation, 0).farthest, 0.0);
    EXPECT_EQ(BodyMotion(simulation, 0).velocity[0], 0.0);
    expect_balanced(simulation);
    run_until(simulation, 0.5);
    EXPECT_GT(BodyMotion(simulation, 0).displacement[0], 0.05);
    expect_balanced(simulation);
  }
}

}  // namespace
}  // namespace thawslide::sim
