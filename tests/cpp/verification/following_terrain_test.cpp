// Cells that follow curved ground: channels, walls, a cliff and a pool.
#include <fstream>

#include "../support/channel_on_dem.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

const Sets following = "grid.follows_terrain=true; time.stepping=adaptive";

TEST(FollowingTerrain, ChannelsHaveTheFrictionOfAWedge) {
  Record record("Cells that follow the ground: V channels",
                "An elastic fill slides in a channel of V section that falls by 35 degrees. The friction angle of the "
                "ground is 15 degrees, cells are 5 m wide, and points of the DEM are 1.25 m apart. Mean from 1 to 3 s.",
                "apparent friction over that of the ground = 1/sin(a), a half the opening angle", "wedge in a groove");
  for (const auto& [opening, azimuth] : {std::pair(120.0, 22.5), std::pair(90.0, 0.0), std::pair(90.0, 33.0)}) {
    Channel channel = v_channel(0.5 * opening, 8.0 * channel_cell);
    channel.azimuth = azimuth;
    const double found = friction_in_channel(channel, elastic_rock(0.01) + following, 1.0, 3.0);
    record.expect_near(
        fmt::format("apparent friction over exact, opening {} degrees, thalweg at {} degrees to the grid", opening,
                    azimuth),
        found * std::sin(0.5 * opening * pi / 180.0), 1.0, 0.02);
  }
}

// Profile of the running test, from points of x and height.
void write_profile(const std::vector<std::pair<double, double>>& points) {
  std::ofstream file(folder_of_this_test() / "profile.csv");
  file << "distance_m,terrain_elevation_m\n";
  for (const auto& [x, z] : points) {
    file << fmt::format("{},{}\n", x, z);
  }
}

// Elastic block of 40 m x 20 m on frictionless ground, given by write_profile; its front is at x = 50 m.
config::Case sliding_block(const Sets& sets) {
  const std::string on_profile =
      "time.end=4; time.step=; time.stepping=adaptive; grid.follows_terrain=true; grid.min=[-90,-300]; "
      "grid.max=[350,80]; terrain.type=profile; material.rock.youngs_modulus=2e8; material.rock.viscosity_time=0.01; "
      "body.block.min=[10,0]; body.block.max=[50,20]; body.block.velocity=[20,0]; basal.friction_angle=0; "
      "terrain.file=";
  return base_case("block", Sets(on_profile + (folder_of_this_test() / "profile.csv").string()) + sets);
}

struct Centre {
  Vector<double, 2> position = Vector<double, 2>::Zero(), velocity = Vector<double, 2>::Zero();

  explicit Centre(const Simulation<2>& simulation) {
    for (int a = 0; a < 2; ++a) {
      const auto& particles = simulation.particles();
      position[a] =
          simulation.model().origin[a] + mass_mean(simulation, [&](auto p) { return particles.position(p, a); });
      velocity[a] = mass_mean(simulation, [&](auto p) { return particles.velocity(p, a); });
    }
  }
};

// Distance of the front from the foot of a wall, in cells, when the block has lost 1 % of its speed.
double distance_of_loss(double wall_angle, double foot) {
  constexpr double height = 60.0, cell = 5.0;
  write_profile(
      {{-100.0, 0.0}, {foot, 0.0}, {foot + height / std::tan(wall_angle * pi / 180.0), height}, {400.0, height}});
  Simulation<2> simulation(sliding_block({"grid.steepest=85"}));
  double edge = 50.0;
  while (Centre(simulation).velocity[0] > 0.99 * 20.0 && simulation.time() < 1.0) {
    simulation.step(simulation.next_step(4.0));
    edge = 50.0 + 20.0 * simulation.time();
  }
  return (foot - edge) / cell;
}

TEST(FollowingTerrain, BlocksKeepTheirVelocityUpToAWall) {
  Record record("Cells that follow the ground: walls",
                "An elastic block slides without friction over level ground towards a wall, whose foot is on a column "
                "of nodes or between two columns; cells of 5 m.",
                "the velocity is kept until the front is at the foot", "motion without force");
  for (const auto& [wall_angle, on_column] : {std::pair(45.0, 0.3), std::pair(60.0, 0.4), std::pair(80.0, 0.9)}) {
    for (const auto& [foot, allowed] : {std::pair(60.0, on_column), std::pair(57.5, 0.6)}) {
      record.expect_near(fmt::format("cells before the foot at a loss of 1 %, wall of {} degrees, foot {} a column",
                                     wall_angle, foot == 60.0 ? "on" : "half a cell from"),
                         std::max(0.0, distance_of_loss(wall_angle, foot)), 0.0, allowed);
    }
  }
  record.explain(
      "The height of a column is the mean of the terrain within a cell. The ground therefore begins to rise up to a "
      "cell "
      "before the foot of a wall.");
}

TEST(FollowingTerrain, ABlockFliesOverACliff) {
  Record record("Cells that follow the ground: fall over a cliff",
                "An elastic block leaves a level plateau at 20 m/s over a cliff of 80 degrees, 200 m high.",
                "parabola of the centre of mass after the rear has left the edge; constant energy", "free fall");
  constexpr double edge = 60.0, height = 200.0;
  write_profile({{-100.0, 0.0}, {edge, 0.0}, {edge + height / std::tan(80.0 * pi / 180.0), -height}, {400.0, -height}});
  Simulation<2> simulation(sliding_block({"grid.max=[350.0,80.0]", "grid.steepest=85"}));
  const auto energy = [&] {
    const auto row = sim::history_row(simulation);
    return value_of(row, "kinetic_J") + value_of(row, "potential_J");
  };
  while (Centre(simulation).position[0] < edge + 30.0) {
    simulation.step(simulation.next_step(10.0));
  }
  const Centre first(simulation);
  const double began = simulation.time(), energy_before = energy();
  run_until(simulation, began + 3.0);
  const double passed = simulation.time() - began;
  const Vector<double, 2> fall(0.0, -0.5 * 9.81 * passed * passed);
  const Centre last(simulation);
  record.expect_near("distance of the centre of mass from the parabola after 3 s [m]",
                     (last.position - first.position - passed * first.velocity - fall).norm(), 0.0, 1.0);
  const double kinetic = value_of(sim::history_row(simulation), "kinetic_J");
  record.expect_near("change of energy over the kinetic energy", (energy() - energy_before) / kinetic, 0.0, 0.01);
}

}  // namespace
}  // namespace thawslide::verification
