// Sides of the grid, rigid frames, and several bodies in one case.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/case_from_text.hpp"
#include "sim/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

// A column between rollers under its own weight, brought to rest by damping.
const std::string column = R"(
[time]
end = 12.0
step = 0.002
[grid]
cell = 2.0
min = [0.0, 0.0]
max = [8.0, 24.0]
[grid.boundary]
x_min = "roller"
x_max = "roller"
y_min = "fixed"
[material.rock]
law = "elastic"
youngs_modulus = 1e8
poisson_ratio = 0.25
[body.column]
material = "rock"
shape = "box"
min = [0.0, 0.0]
max = [8.0, 20.0]
[mechanics]
initial_stress = "none"
mass_damping = 2.0
[heat]
enabled = false
[pressure]
enabled = false
)";

TEST(Boundary, ColumnBetweenRollersCarriesItsWeight) {
  Simulation<2> simulation(paper_case(column));
  run_until(simulation, 12.0);
  const auto& particles = simulation.particles();
  const double weight = particles.mass(0) / particles.initial_volume(0) * 9.81;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double y = particles.position(p, 1);
    if (y > 3.0 && y < 17.0) {
      EXPECT_NEAR(particles.stress(p, 1), -weight * (20.0 - y), 0.03 * weight * 20.0) << "y = " << y;
      EXPECT_NEAR(particles.stress(p, 0) / particles.stress(p, 1), 0.25 / 0.75, 0.02) << "K0, y = " << y;
      EXPECT_NEAR(particles.stress(p, 2), particles.stress(p, 0), 0.05 * weight * 20.0) << "plane strain";
    }
  }
  const auto row = history_row(simulation);
  EXPECT_LT(value_of(row, "max_velocity_m_s"), 1e-3);
  EXPECT_GT(value_of(row, "damping_J"), 0.0);
}

TEST(Boundary, BudgetOfTheColumnClosesInFirstOrderOfTheStep) {
  double residual[2];
  for (int k = 0; k < 2; ++k) {
    Simulation<2> simulation(paper_case(column, {k == 0 ? "time.step=0.002" : "time.step=0.001"}));
    run_until(simulation, 1.0);
    const auto row = history_row(simulation);
    residual[k] = value_of(row, "mechanical_residual_J") / value_of(row, "damping_J");
  }
  EXPECT_LT(std::abs(residual[1]), 0.15);
  EXPECT_NEAR(residual[0] / residual[1], 2.0, 0.1);
}

TEST(Boundary, OpenSideLetsTheColumnSpread) {
  Simulation<2> held(paper_case(column)), open(paper_case(column, {"grid.boundary.x_max=open"}));
  run_until(held, 1.0);
  run_until(open, 1.0);
  EXPECT_LT(history_row(held)[3].second, history_row(open)[3].second) << "mean velocity";
}

TEST(Frame, DrivesNodesWithinAndCountsItsWork) {
  const std::string text = R"(
[case]
gravity = 0.0
[time]
end = 1.0
step = 0.001
[grid]
cell = 2.0
min = [0.0, 0.0]
max = [40.0, 20.0]
[material.rock]
law = "elastic"
youngs_modulus = 1e8
poisson_ratio = 0.25
viscosity_time = 0.01
[body.block]
material = "rock"
shape = "box"
min = [4.0, 4.0]
max = [12.0, 12.0]
[frame.pusher]
min = [0.0, 0.0]
max = [40.0, 20.0]
axis = "x"
velocity = 3.0
)";
  Simulation<2> simulation(paper_case(text));
  run_until(simulation, 1.0);
  const auto row = history_row(simulation);
  EXPECT_NEAR(value_of(row, "mean_velocity_m_s"), 3.0, 1e-9);
  EXPECT_NEAR(value_of(row, "mean_displacement_m"), 3.0, 1e-2);
  EXPECT_NEAR(value_of(row, "frame_work_J") / (0.5 * value_of(row, "mass_kg") * 9.0), 1.0, 1e-9);
}

TEST(Bodies, OfDifferentMaterialsKeepTheirMaterials) {
  const std::string text = R"(
[time]
end = 0.5
step = 0.001
[grid]
cell = 2.0
min = [0.0, 0.0]
max = [40.0, 60.0]
[material.ice]
law = "elastic"
youngs_modulus = 1e8
poisson_ratio = 0.3
[material.rock]
law = "mohr_coulomb"
youngs_modulus = 5e8
poisson_ratio = 0.2
friction_angle = 35.0
cohesion = 1e6
[body.left]
material = "rock"
shape = "box"
min = [4.0, 40.0]
max = [8.0, 44.0]
porosity = 0.1
[body.right]
material = "ice"
shape = "polygon"
vertices = [[20.0, 40.0], [28.0, 40.0], [20.0, 48.0]]
porosity = 0.9
temperature = { depth = [0.0, 4.0], value = [-2.0, -6.0] }
[mechanics]
initial_stress = "none"
)";
  Simulation<2> simulation(paper_case(text));
  const auto& particles = simulation.particles();
  int left = 0, right = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double density = particles.mass(p) / particles.volume(p);
    if (particles.body(p) == 0) {
      ++left;
      EXPECT_NEAR(density, 0.9 * 2750.0 + 0.1 * 917.0, 0.1);
    } else {
      ++right;
      EXPECT_NEAR(density, 0.1 * 2750.0 + 0.9 * 917.0, 4.0);
      EXPECT_LE(particles.temperature(p), -2.0);
      EXPECT_GE(particles.temperature(p), -6.0);
    }
  }
  EXPECT_EQ(left, 16);
  EXPECT_NEAR(right, 32, 4) << "half of an 8 m square, 4 particles a cell";
  run_until(simulation, 0.5);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    EXPECT_NEAR(particles.velocity(p, 1), -9.81 * 0.5, 1e-9) << "both fall alike and stay stress-free";
  }
}

}  // namespace
}  // namespace thawslide::sim
