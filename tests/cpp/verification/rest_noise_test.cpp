// Motion in a body at rest: velocity differences between particles that the grid does not resolve, and that nothing
// damps.
#include <random>

#include "verification.hpp"

namespace thawslide::verification {
namespace {

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
