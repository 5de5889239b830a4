// A flat pile of cohesionless material spreads across the direction in which it slides: Savage and Hutter 1989.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "../support/case_from_text.hpp"
#include "../support/mass_spread.hpp"
#include "../support/record.hpp"
#include "sim/simulation.hpp"

namespace thawslide::verification {
namespace {

using sim::Simulation;

constexpr double height = 20.0, half_length = 200.0, gravity = 9.81, friction_angle = 35.0;

// Friction acts down the slope only, and not across it: here, the base is frictionless.
const std::string column_mass = R"(
[case]
dimension = 2
[time]
end = 20.0
step = 0.045
[grid]
cell = 10.0
min = [-800.0, -40.0]
max = [800.0, 80.0]
[terrain]
type = "flat"
elevation = 0.0
[body.pile]
material = "grains"
shape = "polygon"
temperature = -5.0
porosity = 0.3
[material.grains]
law = "mohr_coulomb"
youngs_modulus = 5.0e7
poisson_ratio = 0.2
friction_angle = 35.0
cohesion = 0.0
[basal]
friction = "coefficient"
friction_coefficient = 0.0
[heat]
enabled = false
[pressure]
enabled = false
)";

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

std::string parabola() {
  std::string vertices;
  for (int k = 80; k >= 0; --k) {
    const double x = half_length * (k / 40.0 - 1.0);
    vertices +=
        fmt::format("{}[{},{}]", vertices.empty() ? "" : ",", x, height * (1.0 - x * x / (half_length * half_length)));
  }
  return "body.pile.vertices=[" + vertices + "]";
}

TEST(ParabolicPile, SpreadsAsSavageAndHutterSay) {
  Record record("Parabolic pile that spreads across its direction of travel",
                "A parabolic pile without cohesion (35 degrees), 20 m high and 400 m long, spreads on a base without "
                "friction that lies on a grid line.",
                "standard deviation of the mass g/sqrt(5): g'' = 2 K g_z H L/g^2, K = tan^2(45 deg - phi/2)",
                "Savage and Hutter 1989");
  for (const double cell : {10.0, 5.0}) {
    Simulation<2> simulation(testing_support::case_from_text(
        column_mass, {fmt::format("grid.cell={}", cell), fmt::format("time.step={}", 4.5e-3 * cell), parabola()}));
    for (const double time : {10.0, 20.0}) {
      testing_support::run_until(simulation, time);
      record.expect_near(fmt::format("spread over exact, cells of {} m, after {} s", cell, time),
                         testing_support::mass_spread(simulation) * std::sqrt(5.0) / exact_half_length(time), 1.0,
                         0.02);
    }
  }
}

}  // namespace
}  // namespace thawslide::verification
