// Bodies at rest: pressure on the ground, the angle at which they start to slide, and velocity differences between
// particles that the grid does not resolve.
#include <random>

#include "../exact/motion.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

const Sets resting{"time.end=2; time.step=0.002; grid.min=[0,-10]; grid.max=[40,40]; grid.boundary.x_min=roller",
                   "grid.boundary.x_max=roller; material.rock.viscosity_time=0; basal.friction_angle=30",
                   "pressure.enabled=true"};

struct Pressing {
  double unevenness = 0.0;  // maximum relative difference of nodal pressure from weight over area
  double ringing = 0.0;     // maximum relative difference of the total force from the weight
};

Pressing press(const Sets& sets) {
  Simulation<2> simulation(published_case("block", resting + sets));
  simulation.settle();
  const double weight = simulation.sum_over_body().mass * gravity;
  const double mean = weight / 40.0;
  Pressing seen;
  while (simulation.time() < 2.0 - 1e-9) {
    simulation.step(simulation.next_step(2.0));
    seen.ringing = std::max(seen.ringing, std::abs(-simulation.contact().force[1] / weight - 1.0));
    for_contacts(simulation, [&](double pressure, double) {
      seen.unevenness = std::max(seen.unevenness, std::abs(pressure / mean - 1.0));
    });
  }
  return seen;
}

TEST(RestingBlock, PressureIsUniform) {
  if (!Simulation<2>(published_case("block", resting)).device_name().empty()) {
    GTEST_SKIP() << "it looks at nodes, which a device keeps";
  }
  Record record("Force of a resting block", "A block of 20 m between smooth walls, with geostatic stress at t = 0.",
                "its weight, spread evenly over the base", "statics");
  for (const double cell : {5.0, 2.5, 1.25}) {
    const Pressing seen = press(fmt::format("grid.cell={}; time.step={}", cell, 1e-3 * cell));
    record.expect_near(fmt::format("cells of {} m: unevenness of the base pressure", cell), seen.unevenness, 0.0,
                       1e-12);
    record.expect_near(fmt::format("cells of {} m: change of the total force in 2 s", cell), seen.ringing, 0.0, 1e-12);
  }
  const Pressing settled =
      press("mechanics.initial_stress=settle; mechanics.settle_time=6; mechanics.settle_damping=8");
  record.expect_near("settled: unevenness of the base pressure", settled.unevenness, 0.0, 1e-3);
  record.expect_near("settled: change of the total force in 2 s", settled.ringing, 0.0, 1e-3);
}

const Sets sweep{"time.end=2; time.step=0.0015; grid.max=[100,40]; material.rock.youngs_modulus=5e9",
                 "material.rock.poisson_ratio=0; material.rock.viscosity_time=0.005; body.block.max=[40,10]",
                 "mechanics.slope_shear=true; pressure.enabled=true"};

TEST(AngleSweep, SticksBelowAndSlidesAboveTheFrictionAngle) {
  Record record("Slopes near the friction angle", "A block at rest on slopes near its friction angle of 20 degrees.",
                "a = g (sin - mu cos) above it, none below", "Coulomb friction");
  Curve curve{"slope [degrees]", "acceleration [m/s2]", {}, {}, {}};
  for (const double slope : {15.0, 18.0, 19.0, 19.9, 20.1, 21.0, 22.0, 25.0, 30.0}) {
    Simulation<2> simulation(published_case("block", sweep + fmt::format("case.gravity_tilt={}", slope)));
    run_until(simulation, 1.0);  // after the elastic transient at the start
    const double before = history_value(simulation, "mean_velocity_m_s");
    run_until(simulation, 2.0);
    const double acceleration = history_value(simulation, "mean_velocity_m_s") - before;
    const double exact = physics::exact::acceleration_on_plane(slope * degree, std::tan(20.0 * degree), 9.81);
    add_point(curve, slope, acceleration, exact);
    record.expect_near(fmt::format("acceleration on {} degrees [m/s2]", slope), acceleration, exact,
                       1e-3 * exact + 1e-6);
  }
  record.draw(curve);
}

const Sets filtered{"mechanics.transfer=fmpm; mechanics.fmpm_interval=0.1"};

// Root mean square speed of particles [m/s].
double speed_of(const Simulation<2>& simulation) {
  const auto row = history_row(simulation);
  return std::sqrt(2.0 * value_of(row, "kinetic_J") / value_of(row, "mass_kg"));
}

const Sets block{"time.end=10; grid.cell=1; grid.min=[-10,-3]; grid.max=[40,20]; material.rock.law=mohr_coulomb",
                 "material.rock.youngs_modulus=1e8; material.rock.friction_angle=35; material.rock.cohesion=1e6",
                 "material.rock.viscosity_time=0.002; body.block.max=[20,8]; mechanics.slope_shear=true",
                 "basal.friction_angle=40"};

// Remaining fraction of a random velocity of 1 m/s per component and particle.
double left_of_noise(double tilt, const Sets& sets) {
  Simulation<2> simulation(published_case("block", block + fmt::format("case.gravity_tilt={}", tilt) + sets));
  std::mt19937 random(5);
  std::normal_distribution<double> number;
  for (std::size_t p = 0; p < simulation.particles().size(); ++p) {
    simulation.particles().velocity.set(p, Vector<double, 2>(number(random), number(random)));
  }
  run_until(simulation, 4.0);
  return speed_of(simulation);
}

TEST(RestNoise, OfABlockIsFilteredOut) {
  Record record("A block at rest that was shaken",
                "A block of 20 by 8 m with viscosity is on level ground, and on a slope of 25 degrees that holds it. "
                "Each particle has a random initial velocity, 1 m/s per component. Speeds 4 s later, filtered "
                "40 times (FMPM of order 2) and not.",
                "nothing moves", "a body at rest");
  for (const double tilt : {0.0, 25.0}) {
    EXPECT_GT(left_of_noise(tilt, {}), 0.3) << "FLIP keeps it";
    record.expect_near(fmt::format("root mean square speed [m/s], slope of {} degrees", tilt),
                       left_of_noise(tilt, filtered), 0.0, 0.01);
  }
}

struct Deposit {
  double speed, front;
};
Deposit collapse(const Sets& sets) {
  Simulation<2> simulation(published_case("sand", "time.end=8; grid.max=[60,20]" + sets));
  run_until(simulation, 8.0);
  return {speed_of(simulation), value_of(history_row(simulation), "front_position_m")};
}

TEST(RestNoise, OfADepositIsFilteredOut) {
  Record record("A deposit at rest",
                "A column of dry sand, 10 m square, that has fallen apart, 8 s after the start; velocities filtered "
                "every 0.1 s. With FLIP, resting sand has 0.4 m/s, by which it continues to spread slightly.",
                "nothing moves; runout over width 1.2", "a body at rest; fit to experiments, Lube et al. 2005");
  const Deposit flip = collapse({});
  EXPECT_GT(flip.speed, 0.3);
  const Deposit still = collapse(filtered);
  record.expect_near("root mean square speed [m/s]", still.speed, 0.0, 0.01);
  record.expect_near("runout over width", still.front / 10.0 - 1.0, 1.2, 0.2 * 1.2);
}

}  // namespace
}  // namespace thawslide::verification
