// Motion in a body at rest: velocity differences between particles that the grid does not resolve, and that nothing
// damps.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "../support/case_from_text.hpp"
#include "../support/dry_sand.hpp"
#include "../support/record.hpp"
#include "sim/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::verification {
namespace {

using namespace testing_support;
using sim::Simulation;

const std::vector<std::string> filtered{"mechanics.transfer=fmpm", "mechanics.fmpm_interval=0.1"};

// Root mean square speed of particles [m/s].
double speed_of(const Simulation<2>& simulation) {
  const auto row = history_row(simulation);
  return std::sqrt(2.0 * value_of(row, "kinetic_J") / value_of(row, "mass_kg"));
}

const std::string block = R"(
[case]
gravity_tilt = TILT
[time]
end = 10.0
step = 0.001
[grid]
cell = 1.0
min = [-10.0, -3.0]
max = [40.0, 20.0]
[terrain]
type = "flat"
elevation = 0.0
[material.rock]
law = "mohr_coulomb"
youngs_modulus = 1e8
poisson_ratio = 0.2
friction_angle = 35.0
cohesion = 1e6
viscosity_time = 0.002
[body.block]
material = "rock"
min = [0.0, 0.0]
max = [20.0, 8.0]
[mechanics]
slope_shear = true
)" + friction_alone(40.0);

// Remaining fraction of a random velocity of 1 m/s per component and particle.
double left_of_noise(double tilt, const std::vector<std::string>& sets) {
  std::string text = block;
  text.replace(text.find("TILT"), 4, fmt::format("{}", tilt));
  Simulation<2> simulation(paper_case(text, sets));
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

const std::string column = dry_sand(2e7) + R"(
[time]
end = 8.0
step = 0.0035
[grid]
cell = 0.625
min = [0.0, -2.5]
max = [60.0, 20.0]
[grid.boundary]
x_min = "roller"
[terrain]
type = "flat"
elevation = 0.0
[body.column]
material = "sand"
min = [0.0, 0.0]
max = [10.0, 10.0]
)";

struct Deposit {
  double speed, front;
};
Deposit collapse(const std::vector<std::string>& sets) {
  Simulation<2> simulation(paper_case(column, sets));
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
