// Spreading: a pile of cohesionless material (Savage and Hutter 1989), and flow without strength and friction through
// sections of varying width, for which thin flow has an exact solution.
#include "../support/following_plane.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

constexpr double height = 20.0, half_length = 200.0, friction_angle = 35.0;

// Friction acts down the slope only, and not across it: here, the base is frictionless.
const Sets column_mass{"time.end=20; grid.min=[-800,-40]; grid.max=[800,80]; material.rock.law=mohr_coulomb",
                       "material.rock.youngs_modulus=5e7; material.rock.viscosity_time=0",
                       "material.rock.friction_angle=35; material.rock.cohesion=0; body.block.shape=polygon",
                       "body.block.temperature=-5; body.block.porosity=0.3; basal.friction_angle=0"};

// Half the length g [m] of the parabolic cap after `time` [s]: h = H L/g (1 - (x/g)^2), and its edge moves by
//   g'' = 2 K gravity H L/g^2,     K = tan^2(45 deg - phi/2), active: it stretches
double exact_half_length(double time) {
  constexpr int steps = 20000;
  const double active = std::pow(std::tan(pi / 4.0 - friction_angle * pi / 360.0), 2);
  const double dt = time / steps;
  double length = half_length, speed = 0.0;
  for (int k = 0; k < steps; ++k) {
    speed += dt * 2.0 * active * gravity * height * half_length / (length * length);
    length += dt * speed;
  }
  return length;
}

// Outline of the cap on a base, along which and normal to which its vertices are given.
std::vector<Vector<double, 2>> cap_on(const Incline& base) {
  std::vector<Vector<double, 2>> vertices;
  for (int k = 80; k >= 0; --k) {
    const double x = half_length * (k / 40.0 - 1.0);
    vertices.push_back(base.place(x, height * (1.0 - x * x / (half_length * half_length))));
  }
  return vertices;
}

TEST(ParabolicPile, SpreadingAgreesWithSavageAndHutter) {
  Record record("Parabolic pile that spreads across its direction of travel",
                "A parabolic pile without cohesion (35 degrees), 20 m high and 400 m long, spreads on a base without "
                "friction that lies on a grid line.",
                "standard deviation of the mass g/sqrt(5): g'' = 2 K g_z H L/g^2, K = tan^2(45 deg - phi/2)",
                "Savage and Hutter 1989");
  for (const double cell : {10.0, 5.0}) {
    const Sets of_cell{fmt::format("grid.cell={}; time.step={}", cell, 4.5e-3 * cell),
                       "body.block.vertices=" + list_of(cap_on({0.0}))};
    Simulation<2> simulation(base_case("block", column_mass + of_cell));
    for (const double time : {10.0, 20.0}) {
      run_until(simulation, time);
      record.expect_near(fmt::format("spread over exact, cells of {} m, after {} s", cell, time),
                         mass_spread(simulation) * std::sqrt(5.0) / exact_half_length(time), 1.0, 0.02);
    }
  }
}

TEST(ParabolicPile, SpreadsOnPlanesInCellsThatFollowThem) {
  Record record("Cells that follow the ground: parabolic pile on planes",
                "The pile of the test above on inclined planes; gravity is normal to the plane.",
                "standard deviation of the mass g/sqrt(5): g'' = 2 K g_z H L/g^2, K = tan^2(45 deg - phi/2)",
                "Savage and Hutter 1989");
  for (const double degrees : {0.0, 15.0, 30.0}) {
    const Incline plane{degrees};
    for (const double cell : {10.0, 5.0}) {
      Simulation<2> simulation(body_on_plane(
          plane, cell, cap_on(plane), {fmt::format("case.gravity_tilt={}", -degrees), "basal.friction_angle=0"}));
      run_until(simulation, 20.0);
      const std::string where = fmt::format(", plane of {} degrees, cells of {} m", degrees, cell);
      record.expect_near("spread over exact" + where,
                         mass_spread(simulation, plane.down()) * std::sqrt(5.0) / exact_half_length(20.0), 1.0, 0.013);
      record.expect_near("growth of the volume" + where, volume_growth(simulation), 0.0, 0.03);
    }
  }
}

const Sets fluid{"time.step=0.003; grid.max=[320,10]; grid.boundary.x_min=open; material.sand.friction_angle=0",
                 "material.sand.tension_cutoff=0; basal.friction_angle=0"};

// A body that flows from a channel into one twice as wide. Its ends do not affect its middle, where the flow is steady:
//   h u b = const,  u^2/2 + g h = const
TEST(WideningSection, HalvesTheDepthWhereTheWidthDoubles) {
  constexpr double depth = 2.5, speed = 40.0, time = 4.0;
  Record record(
      "Flow into a wider channel",
      "Material without strength or friction, 2.5 m deep and 80 m long, runs at 40 m/s from a channel 20 m wide "
      "into one 40 m wide.",
      "depth and speed of the middle by h u b = const, u^2/2 + g h = const", "Bernoulli");
  const Sets channel{"case.width={ x = [120.0, 160.0], value = [20.0, 40.0] }; body.column.min=[10,0]",
                     "body.column.max=[90,2.5]; body.column.velocity=[40,0]"};
  Simulation<2> simulation(published_case("sand", fluid + channel));
  const double density = simulation.particles().mass(0) / simulation.particles().volume(0);
  run_until(simulation, time);
  double exact = 0.5 * depth;
  for (int k = 0; k < 50; ++k) {
    exact = 0.5 * depth * speed / std::sqrt(speed * speed + 2.0 * gravity * (depth - exact));
  }
  const auto& particles = simulation.particles();
  const double from = 200.0, to = 220.0;
  double mass = 0.0, momentum = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (particles.position(p, 0) > from && particles.position(p, 0) < to) {
      mass += particles.mass(p);
      momentum += particles.mass(p) * particles.velocity(p, 0);
    }
  }
  record.expect_near("mass over exact", mass / (density * 2.0 * (to - from) * exact), 1.0, 0.01);
  record.expect_near("speed over exact", momentum / mass / (0.5 * depth * speed / exact), 1.0, 0.002);
}

// A paraboloid of thin flow remains a paraboloid while it spreads (Thacker 1981): its radius grows as R0 s(t), with
//   s'' = 2 g h0/(R0^2 s^(n + 1)),  s(0) = 1,  s'(0) = 0
// n = 1 in the plane; n = 2 for axial symmetry, where s^2 = 1 + 2 g h0 t^2/R0^2, and in a section b = x.
double spread(int n, double rate, double time) {
  double s = 1.0, growth = 0.0;
  constexpr int steps = 10000;
  const double dt = time / steps;
  for (int k = 0; k < steps; ++k) {  // leapfrog
    growth += 0.5 * dt * rate / std::pow(s, n + 1);
    s += dt * growth;
    growth += 0.5 * dt * rate / std::pow(s, n + 1);
  }
  return s;
}

TEST(WideningSection, SpreadsAsAParaboloidAboutItsAxis) {
  constexpr double radius = 50.0, depth = 5.0, time = 6.0, rate = 2.0 * gravity * depth / (radius * radius);
  Record record("Paraboloid that spreads",
                "Material without strength or friction, 5 m deep at x = 0 and 50 m long, spreads over level ground. "
                "The section has a constant width, or the width x, which is a sector about the axis.",
                "mean x over that at the start: s(t) with s'' = 2 g h0/(R0^2 s^(n + 1)), n = 1 and 2", "Thacker 1981");
  ASSERT_NEAR(spread(2, rate, time), std::sqrt(1.0 + rate * time * time), 1e-6);
  std::vector<Vector<double, 2>> vertices{{0.0, 0.0}};
  for (int k = 20; k >= 0; --k) {
    const double x = 2.5 * k;
    vertices.emplace_back(x, depth * (1.0 - x * x / (radius * radius)));
  }
  for (const auto& [n, width] : {std::pair(1, "0.0"), std::pair(2, "{ x = [0.5, 1000.0], value = [0.5, 1000.0] }")}) {
    const Sets paraboloid{fmt::format("case.width={}; body.column.shape=polygon", width),
                          "grid.boundary.x_min=roller; body.column.vertices=" + list_of(vertices)};
    Simulation<2> simulation(published_case("sand", fluid + paraboloid));
    const auto mean_x = [&] {
      return mass_mean(simulation, [&](std::size_t p) { return simulation.particles().position(p, 0); });
    };
    const double before = mean_x();
    // Mean of r over (0, 1) with the weight (1 - r^2) r^(n-1): 3/8, 8/15.
    EXPECT_NEAR(before / radius, n == 1 ? 3.0 / 8.0 : 8.0 / 15.0, 0.005);
    run_until(simulation, time);
    const double exact = spread(n, rate, time) - 1.0;
    record.expect_near(fmt::format("growth of the mean x, n = {}, over exact", n), (mean_x() / before - 1.0) / exact,
                       1.0, 0.01);
  }
}

}  // namespace
}  // namespace thawslide::verification
