// Cells that follow the ground: walls, a cliff, a dam, a dyke and a pool.
#include <memory>
#include <random>

#include "../support/following_plane.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

// Elastic block of 40 m x 20 m on frictionless ground with points of x and height; its front is at x = 50 m.
config::Case sliding_block(const std::vector<std::vector<double>>& ground, const Sets& sets) {
  const std::string on_profile =
      "time.end=4; time.step=; time.stepping=adaptive; grid.min=[-90,-300]; "
      "grid.max=[350,80]; terrain.type=profile; material.rock.youngs_modulus=2e8; material.rock.viscosity_time=0.01; "
      "body.block.min=[10,0]; body.block.max=[50,20]; body.block.velocity=[20,0]; basal.friction_angle=0; "
      "terrain.file=";
  return base_case("block", Sets(on_profile + write_profile(ground)) + sets);
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
  Simulation<2> simulation(sliding_block(
      {{-100.0, 0.0}, {foot, 0.0}, {foot + height / std::tan(wall_angle * degree), height}, {400.0, height}},
      "grid.steepest=85"));
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

// A dam from `begin` [m], two columns wide and 30 m high. Greatest height of the columns and, after 4 s, place of the
// foremost particle of a block that slides towards it [m].
std::pair<double, double> crest_and_front(double begin) {
  constexpr double cell = 5.0, height = 30.0;
  const double end = begin + 2.0 * cell;
  Simulation<2> simulation(sliding_block(
      {{-100.0, 0.0}, {begin, 0.0}, {begin + 0.01, height}, {end - 0.01, height}, {end, 0.0}, {400.0, 0.0}},
      "grid.steepest=85"));
  run_until(simulation, 4.0);
  const auto& model = simulation.model();
  double crest = 0.0;
  for (double x = begin - cell; x <= end + cell; x += 0.25 * cell) {
    const Vector<double, 1> place(x - model.origin[0]);
    crest = std::max(crest, model.ground->height(place, 0) + model.origin[1]);
  }
  const auto& position = simulation.particles().position;
  return {crest, greatest_of(simulation, [&](std::size_t p) { return model.origin[0] + position(p, 0); })};
}

TEST(FollowingTerrain, ADamTwoColumnsWideHoldsABlock) {
  Record record(
      "Cells that follow the ground: dam",
      "An elastic block, 20 m high, slides without friction at 20 m/s towards a dam two columns wide and 30 m "
      "high; cells of 5 m.",
      "the columns keep the height, and the block does not pass the crest", "terrain");
  for (const auto& [begin, allowed] : {std::pair(60.0, 0.1), std::pair(62.5, 0.13)}) {
    const auto [crest, front] = crest_and_front(begin);
    const std::string where = begin == 60.0 ? ", middle on a column" : ", middle between columns";
    record.expect_near("height of the columns over that of the dam" + where, crest / 30.0, 1.0, allowed);
    record.expect_near("cells by which the block has passed the crest after 4 s" + where,
                       std::max(0.0, (front - begin - 5.0) / 5.0), 0.0, 1e-9);
  }
  record.explain(
      "The ground of the cells keeps 94 % of the height if the middle of the dam is on a column, and 87 % if it is "
      "between two columns. In the latter case, the mean of a dam with upright faces over either column is 7/8 of its "
      "height.");
}

TEST(FollowingTerrain, ABlockRestsBehindADyke) {
  Record record("Cells that follow the ground: dyke between two blocks",
                "An elastic block of 10 m x 10 m slides at 20 m/s against a dyke 2 m wide and 40 m high. Another block "
                "is 1 m behind the dyke, on ground with a friction angle of 30 degrees; cells of 1 m.",
                "the block behind the dyke is at rest, and the other remains before it", "contact through a dyke");
  Simulation<2> simulation(sliding_block(
      {{-100.0, 0.0}, {59.0, 0.0}, {59.01, 40.0}, {61.0, 40.0}, {61.01, 0.0}, {400.0, 0.0}},
      "grid.cell=1; grid.steepest=85; basal.friction_angle=30; material.rock.viscosity_time=0.001; "
      "body.block.min=[40.0,0.0]; body.block.max=[50.0,10.0]; body.behind.material=rock; body.behind.min=[62.0,0.0]; "
      "body.behind.max=[72.0,10.0]; body.behind.temperature=-5; "
      "body.behind.porosity=0.3"));
  run_until(simulation, 1.2);
  const auto& particles = simulation.particles();
  double greatest = 0.0, front = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (simulation.model().body_names[static_cast<std::size_t>(particles.body(p))] == "behind") {
      greatest = std::max(greatest, particles.displacement.get<Vector<double, 2>>(p).norm());
    } else {
      front = std::max(front, simulation.model().origin[0] + particles.position(p, 0));
    }
  }
  record.expect_near("greatest displacement behind the dyke after 1.2 s [m]", greatest, 0.0, 0.02);
  EXPECT_LT(front, 60.0);
}

TEST(FollowingTerrain, ABlockFliesOverACliff) {
  Record record("Cells that follow the ground: fall over a cliff",
                "An elastic block leaves a level plateau at 20 m/s over a cliff of 80 degrees, 200 m high.",
                "parabola of the centre of mass after the rear has left the edge; constant energy", "free fall");
  constexpr double edge = 60.0, height = 200.0;
  Simulation<2> simulation(
      sliding_block({{-100.0, 0.0}, {edge, 0.0}, {edge + height / std::tan(80.0 * degree), -height}, {400.0, -height}},
                    "grid.max=[350.0,80.0]; grid.steepest=85"));
  const auto energy = [&] { return history_value(simulation, "kinetic_J") + history_value(simulation, "potential_J"); };
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
  record.expect_near("growth of the volume", volume_growth(simulation), 0.0, 0.01);
  const double kinetic = history_value(simulation, "kinetic_J");
  record.expect_near("change of energy over the kinetic energy", (energy() - energy_before) / kinetic, 0.0, 0.01);
}

// Pool without cohesion, 200 m long and up to 40 m deep, on ground from x = 0 to 200 m. The
// friction angle [degrees] is that inside and at the base. The nearly incompressible material is in equilibrium.
class Pool {
 public:
  static constexpr double cell = 10.0, surface = 40.0, length = 200.0;  // [m]

  Pool(const std::vector<std::vector<double>>& ground, double friction_angle, const Sets& sets) {
    std::vector<Vector<double, 2>> vertices;
    for (const auto& point : ground) {
      if (point[0] >= 0.0 && point[0] <= length && point[1] < surface) {
        vertices.emplace_back(point[0], point[1]);
      }
    }
    vertices.insert(vertices.end(), {{length, surface}, {0.0, surface}});
    const Sets pool =
        "time.end=20; time.step=; time.stepping=adaptive; grid.cell=10; grid.min=[0,-50]; "
        "grid.max=[200,100]; grid.boundary.x_min=roller; grid.boundary.x_max=roller; terrain.type=profile; "
        "material.rock.law=mohr_coulomb; material.rock.youngs_modulus=5e7; material.rock.poisson_ratio=0.49; "
        "material.rock.viscosity_time=; material.rock.cohesion=0; body.block.shape=polygon; body.block.min=; "
        "body.block.max=";
    simulation_ = std::make_unique<Simulation<2>>(base_case(
        "block",
        pool + sets +
            Sets(fmt::format("terrain.file={}; body.block.vertices={}", write_profile(ground), list_of(vertices))) +
            Sets(fmt::format("material.rock.friction_angle={0}; basal.friction_angle={0}", friction_angle))));
  }

  // Greatest mean speed of the particles until `time` [s].
  double speed_until(double time) {
    double greatest = 0.0;
    while (simulation_->time() < time - 1e-9) {
      simulation_->step(simulation_->next_step(time));
      const auto& particles = simulation_->particles();
      greatest = std::max(greatest, mass_mean(*simulation_, [&](auto p) {
                            return std::hypot(particles.velocity(p, 0), particles.velocity(p, 1));
                          }));
    }
    return greatest;
  }

  // Differences of the pressure of nodes from rho g h, where the pool is deeper than half a cell, over rho g 40 m.
  [[nodiscard]] std::vector<double> pressure_errors() const {
    std::vector<double> errors;
    const auto& model = simulation_->model();
    const auto& particles = simulation_->particles();
    const double weight = gravity * particles.mass(0) / particles.initial_volume(0);
    for_contacts(*simulation_, [&](double pressure, double x) {
      const double depth = surface - model.origin[1] - model.ground->height(Vector<double, 1>(x), 0);
      if (x >= 0.0 && x <= length && depth > 0.5 * cell) {
        errors.push_back(pressure / (weight * surface) - depth / surface);
      }
    });
    return errors;
  }

 private:
  std::unique_ptr<Simulation<2>> simulation_;
};

TEST(FollowingTerrain, APoolRemainsAtRest) {
  Record record(
      "Cells that follow the ground: a pool with a level surface",
      "A pool without cohesion, up to 40 m deep, rests on noise or in a V. The noise is 1 m rms on points 5 m "
      "apart, and the slopes of the V are 0.4; cells of 10 m. Particles have the friction angle of the ground.",
      "no motion; pressure rho g h", "hydrostatics");
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.1 * Pool::cell);
  std::vector<std::vector<double>> rough;
  for (double x = -50.0; x <= 250.0; x += 0.5 * Pool::cell) {
    rough.push_back({x, noise(random)});
  }
  const std::vector<std::vector<double>> valley{
      {-100.0, 80.0}, {0.0, 40.0}, {100.0, 0.0}, {200.0, 40.0}, {300.0, 80.0}};
  for (const auto& [friction_angle, transfer] :
       {std::pair(0.0, "apic"), std::pair(20.0, "apic"), std::pair(20.0, "flip")}) {
    for (const auto& ground : {rough, valley}) {
      Pool pool(ground, friction_angle,
                fmt::format("mechanics.transfer={}; {}", transfer,
                            transfer == std::string("flip") ? "material.rock.viscosity_number=0.3" : ""));
      const std::string where =
          fmt::format(", {}, {} degrees, {}", ground == rough ? "noise" : "V", friction_angle, transfer);
      const double first = pool.speed_until(15.0), last = pool.speed_until(20.0);
      record.expect_near("mean speed after 15 s, greatest [m/s]" + where, last, 0.0, 0.01);
      record.expect_near("rms error of the pressure of nodes over the greatest" + where,
                         root_mean_square(pool.pressure_errors()), 0.0, 0.05);
      EXPECT_LE(last, first) << where;
    }
  }
  record.explain(
      "The rows with APIC have the default viscosity, and those with FLIP a viscosity number of 0.3. With FLIP and the "
      "default, a pool at rest flutters, on level ground too.");
}

}  // namespace
}  // namespace thawslide::verification
