// A flat pile of cohesionless material spreads across the direction in which it slides: Savage and Hutter 1989.
#include "../support/following_plane.hpp"
#include "../support/mass_spread.hpp"
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

}  // namespace
}  // namespace thawslide::verification
