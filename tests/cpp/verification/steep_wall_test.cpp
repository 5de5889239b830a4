// A block that slides without friction into a wall keeps its velocity until it reaches the wall.
#include <fstream>

#include "verification.hpp"

namespace thawslide::verification {
namespace {

constexpr double cell = 5.0, front = 50.0, speed = 20.0;  // m, m, m/s

// An elastic block, 40 m long and 20 m high, on level ground from which a wall rises at `foot` [m].
config::Case block_before_wall(double wall_angle, double foot) {
  constexpr double height = 40.0;
  const double run = std::max(1e-3, height / std::tan(wall_angle * degree));
  const std::filesystem::path file = folder_of_this_test() / "wall.csv";
  std::ofstream(file) << fmt::format("distance_m,terrain_elevation_m\n-100,0\n{0},0\n{1},{2}\n{3},{2}\n", foot,
                                     foot + run, height, foot + run + 100.0);
  return published_case("block",
                        {"time.step=0.004; grid.min=[-90,-20]; grid.max=[150,80]; material.rock.youngs_modulus=2e8",
                         "material.rock.viscosity_time=0.01; body.block.min=[10,0]; body.block.max=[50,20]",
                         "body.block.velocity=[20,0]; basal.friction_angle=0; terrain.type=profile",
                         fmt::format("terrain.file={}", file.string())});
}

// Distance of the block's front from the foot of the wall, in cells, when the block has lost a fraction of its speed.
double distance_of_loss(double wall_angle, double foot, double fraction) {
  Simulation<2> simulation(block_before_wall(wall_angle, foot));
  const auto mean_velocity = [&] {
    return mass_mean(simulation, [&](std::size_t p) { return simulation.particles().velocity(p, 0); });
  };
  double edge = front;
  while (mean_velocity() > (1.0 - fraction) * speed && simulation.time() < 1.0 - 1e-9) {
    simulation.step(simulation.next_step(1.0));
    edge = front + speed * simulation.time();
  }
  return (foot - edge) / cell;
}

TEST(SteepWall, KeepsItsVelocityUntilItArrives) {
  Record record(
      "Walls",
      "An elastic block slides without friction over level ground into a wall of 45 to 90 degrees, whose foot "
      "is at different places in cells of 5 m.",
      "the velocity is kept until the front is at the foot", "motion without force");
  for (const double wall_angle : {45.0, 60.0, 80.0, 90.0}) {
    double earliest = -HUGE_VAL, latest = HUGE_VAL;
    for (const double foot : {57.5, 59.0, 60.0, 61.0}) {
      const double distance = distance_of_loss(wall_angle, foot, 0.01);
      earliest = std::max(earliest, distance);
      latest = std::min(latest, distance);
    }
    record.expect_near(fmt::format("cells before the foot at a loss of 1 %, earliest, wall of {} degrees", wall_angle),
                       std::max(0.0, earliest), 0.0, 0.3);
    record.expect_near(fmt::format("cells before the foot at a loss of 1 %, latest, wall of {} degrees", wall_angle),
                       std::min(0.0, latest), 0.0, 0.5);
  }
}

}  // namespace
}  // namespace thawslide::verification
