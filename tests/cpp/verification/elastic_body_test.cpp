// Elastic bodies in free motion: impact on the ground, and rotation under stress.
#include <tuple>
#include <utility>

#include "../exact/motion.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

const Sets falling{"case.gravity=0; time.end=3; grid.min=[0,-4]; grid.max=[8,60]",
                   "material.rock.poisson_ratio=0; material.rock.viscosity_time=0; body.block.velocity=[0,-1]",
                   "mechanics.initial_stress=none; basal.friction_angle=0; pressure.enabled=true"};

// The bar on cells of a given size, its lower end at a given height; steps are a fifth of the time in which a wave
// crosses a cell.
Simulation<2> falling_bar(double cell, double height, bool distance_check = true) {
  const Sets bar =
      fmt::format("grid.cell={}; time.step={}; body.block.min=[0,{}]; body.block.max=[{},{}]; basal.distance_check={}",
                  cell, 2.5e-4 * cell, height, 2.0 * cell, 20.0 + height, distance_check);
  // Without the check it gains energy.
  return Simulation<2>(published_case("block", falling + bar + "guards.energy_growth=inf"));
}

TEST(ElasticImpact, ConservesEnergy) {
  Record record("Impact of an elastic bar",
                "A bar of 20 m, whose lower end touches the ground at t = 0, moves into it at 1 m/s.",
                "it leaves with the speed it came with after 2 H/c; pressure rho c v until then",
                "Timoshenko and Goodier 1951, ch. 15");
  const std::vector<double> cells{2.0, 1.0, 0.5, 0.25};
  std::vector<double> speed_error, energy_error, pressure_error, contact_loss;
  Curve curve{"time [s]", "pressure on the ground [MPa]", {}, {}, {}};
  for (const double cell : cells) {
    Simulation<2> simulation = falling_bar(cell, 0.0);
    const auto before = simulation.sum_over_body();
    const double width = 2.0 * cell, density = before.mass / (width * 20.0);
    const double pressure = physics::exact::impact_pressure(density, 5e8, 1.0);
    const double duration = physics::exact::impact_time(density, 5e8, 20.0);
    double mean = 0.0;
    int samples = 0;
    while (simulation.time() < 1.5 * duration) {
      simulation.step(simulation.parameters().time.step);
      const double force = -simulation.contact().force[1];
      if (simulation.time() > 0.2 * duration && simulation.time() < 0.8 * duration) {
        mean += force / width;
        ++samples;
      }
      if (cell == 0.5) {
        add_point(curve, simulation.time(), force / width / 1e6, simulation.time() < duration ? pressure / 1e6 : 0.0);
      }
    }
    const auto after = simulation.sum_over_body();
    speed_error.push_back(1.0 - after.momentum[1] / before.mass);
    energy_error.push_back(1.0 - after.kinetic / before.kinetic);
    contact_loss.push_back(simulation.budget().contact_loss / before.kinetic);
    pressure_error.push_back(std::abs(mean / samples / pressure - 1.0));
  }
  record.draw(curve);
  record.expect_order("cell [m]", cells, "speed lost, over speed before", speed_error, 2.0 / 3.0, 0.1);
  record.expect_order("cell [m]", cells, "energy taken by contact, over kinetic energy", contact_loss, 1.0, 0.05);
  record.explain(
      "A scheme of second order without dissipation spreads a jump over a width that grows as cell^(2/3) t^(1/3); the "
      "waves behind the front keep their energy. A chain of point masses that hits the ground shows the same order, "
      "0.67 on 2560 masses. Contact stops the lowest node at once: the energy of its mass is lost, in first order.");
  record.expect_near("kinetic energy lost, over that before, cells of 0.25 m", energy_error.back(), 0.0, 0.025);
  record.expect_near("mean pressure over exact, less 1, cells of 0.25 m", pressure_error.back(), 0.0, 0.002);
}

struct Landing {
  double height = 0.0;  // of the lower end at the first force [m]
  double energy = 0.0;  // kinetic energy after the impact, relative to that before
};

// The bar starts two cells above the ground; its energy is measured after it has rebounded.
Landing land(double cell, bool distance_check) {
  Simulation<2> simulation = falling_bar(cell, 2.0 * cell, distance_check);
  const auto before = simulation.sum_over_body();
  const double duration = physics::exact::impact_time(before.mass / (2.0 * cell * 20.0), 5e8, 20.0);
  Landing landing;
  bool felt = false;
  while (simulation.time() < 2.0 * cell + 2.0 * duration) {
    simulation.step(simulation.parameters().time.step);
    if (!felt && simulation.contact().force[1] < 0.0) {
      felt = true;
      landing.height = 2.0 * cell - simulation.time();
    }
  }
  landing.energy = simulation.sum_over_body().kinetic / before.kinetic;
  return landing;
}

TEST(ElasticImpact, BeginsWhenTheEdgesTouch) {
  Record record("Early contact",
                "The same bar comes from two cells above the ground, with basal.distance_check on and off.",
                "its lower end touches at height 0; it leaves with the energy it came with", "docs/theory/contact.md");
  const std::vector<double> cells{2.0, 1.0, 0.5};
  std::vector<double> early;
  for (const double cell : cells) {
    const Landing checked = land(cell, true);
    record.expect_near(fmt::format("height at the first force over the cell, checked, cells of {} m", cell),
                       checked.height / cell, 0.0, 0.003);
    record.expect_near(fmt::format("energy after over before, checked, cells of {} m", cell), checked.energy, 1.0, 0.1);
    const Landing unchecked = land(cell, false);
    early.push_back(unchecked.height);
    EXPECT_GT(unchecked.energy, 1.5);
  }
  record.explain(
      "Without the check, the ground acts on a node as soon as the edge of the bar is in its support, when it has "
      "almost no mass. The bar is then compressed a cell above the ground and leaves with 1.8 to 1.9 times its energy. "
      "With the check, the ground acts when the particles' edges arrive. The loss is then the energy of the lowest "
      "nodes, as in the impact above.");
  record.expect_order("cell [m]", cells, "height of the lower end at the first force, unchecked [m]", early, 1.0, 0.01);
}

const Sets turning{"time.end=1.6; grid.min=[-15,-15]; grid.max=[15,15]",
                   "material.rock.youngs_modulus=2e7; material.rock.poisson_ratio=0.3; body.block.shape=polygon"};

std::string circle(double radius) {
  std::vector<Vector<double, 2>> corners;
  for (int k = 0; k < 360; ++k) {
    corners.emplace_back(radius * std::cos(k * degree), radius * std::sin(k * degree));
  }
  return list_of(corners);
}

// Components xx, yy and xy of the stress at a place relative to the axis.
std::tuple<double, double, double> in_plane(const physics::exact::TurningCylinder::Stress& stress, double x, double y) {
  const double r = std::hypot(x, y), c = x / r, s = y / r;
  return {stress.radial * c * c + stress.around * s * s, stress.radial * s * s + stress.around * c * c,
          (stress.radial - stress.around) * s * c};
}

// Error of the stress within 0.7 of the radius after a time, rms relative to the maximum stress.
double stress_error(const Simulation<2>& simulation, const physics::exact::TurningCylinder& exact) {
  const auto& particles = simulation.particles();
  std::vector<double> errors;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double x = particles.position(p, 0) - 15.0, y = particles.position(p, 1) - 15.0;
    if (std::hypot(x, y) < 0.7 * exact.radius) {
      const auto [xx, yy, xy] = in_plane(exact.at(std::hypot(x, y)), x, y);
      errors.insert(errors.end(),
                    {particles.stress(p, 0) - xx, particles.stress(p, 1) - yy, particles.stress(p, 3) - xy});
    }
  }
  return root_mean_square(errors) / exact.at(0.0).radial;
}

TEST(Rotation, StressRotatesWithTheBody) {
  Record record("A stressed cylinder turns",
                "An elastic cylinder turns by 90 degrees about its axis, under the stress that turning "
                "gives it.",
                "s_r, s_t of the turning cylinder, at every angle", "Timoshenko and Goodier 1951, ch. 4");
  const std::vector<double> cells{2.0, 1.0, 0.5};
  std::vector<double> errors, spins;
  for (const double cell : cells) {
    Simulation<2> simulation(
        published_case("free", turning + Sets(fmt::format("grid.cell={}; time.step={}; body.block.vertices={}", cell,
                                                          2.5e-3 * cell, circle(10.0)))));
    auto& particles = simulation.particles();
    const physics::exact::TurningCylinder exact{particles.mass(0) / particles.volume(0), 0.3, 1.0, 10.0};
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const double x = particles.position(p, 0) - 15.0, y = particles.position(p, 1) - 15.0;
      const auto stress = exact.at(std::hypot(x, y));
      particles.velocity(p, 0) = -y;
      particles.velocity(p, 1) = x;
      std::tie(particles.stress(p, 0), particles.stress(p, 1), particles.stress(p, 3)) = in_plane(stress, x, y);
      particles.stress(p, 2) = stress.along;
    }
    double worst = 0.0;
    for (int part = 1; part <= 4; ++part) {
      run_until(simulation, part * 0.125 * pi);
      worst = std::max(worst, stress_error(simulation, exact));
    }
    errors.push_back(worst);
    double spin = 0.0, inertia = 0.0;
    const auto& turned = std::as_const(simulation).particles();  // reread: a device may have modified them
    for (std::size_t p = 0; p < turned.size(); ++p) {
      const double x = turned.position(p, 0) - 15.0, y = turned.position(p, 1) - 15.0;
      spin += x * turned.velocity(p, 1) - y * turned.velocity(p, 0);
      inertia += x * x + y * y;
    }
    spins.push_back(std::abs(spin / inertia - 1.0));
  }
  record.expect_order("cell [m]", cells, "error of the angular speed after 90 degrees [rad/s]", spins, 2.0, 0.2);
  record.expect_order("cell [m]", cells, "largest rms error of stress over the turn, over s_r(0)", errors, 1.0, 0.15);
}

}  // namespace
}  // namespace thawslide::verification
