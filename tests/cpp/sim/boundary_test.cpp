// Sides of the grid, rigid frames, and several bodies in one case.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/base_cases.hpp"
#include "sim/records/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

// A column between rollers under its own weight, brought to rest by damping.
const Variant column{
    "free",
    "case.gravity=9.81; time.end=12; grid.cell=2; grid.max=[8,24]; grid.boundary.x_min=roller; "
    "grid.boundary.x_max=roller; grid.boundary.y_min=fixed; body.block.min=[0,0]; body.block.max=[8,20]; "
    "mechanics.mass_damping=2"};

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
  const Sets pushed =
      "time.step=0.001; grid.cell=2; grid.max=[40,20]; material.rock.viscosity_time=0.01; body.block.min=[4,4]; "
      "body.block.max=[12,12]; frame.pusher.min=[0,0]; frame.pusher.max=[40,20]; frame.pusher.axis=x; "
      "frame.pusher.velocity=3; mechanics.initial_stress=geostatic; heat.enabled=true; pressure.enabled=true";
  Simulation<2> simulation(published_case("free", pushed));
  run_until(simulation, 1.0);
  const auto row = history_row(simulation);
  EXPECT_NEAR(value_of(row, "mean_velocity_m_s"), 3.0, 1e-9);
  EXPECT_NEAR(value_of(row, "mean_displacement_m"), 3.0, 1e-2);
  EXPECT_NEAR(value_of(row, "frame_work_J") / (0.5 * value_of(row, "mass_kg") * 9.0), 1.0, 1e-9);
}

TEST(Bodies, OfDifferentMaterialsKeepTheirMaterials) {
  const Sets two =
      "case.gravity=9.81; time.end=0.5; time.step=0.001; grid.cell=2; grid.max=[40,60]; material.ice.law=elastic; "
      "material.ice.youngs_modulus=1e8; material.ice.poisson_ratio=0.3; material.rock.law=mohr_coulomb; "
      "material.rock.youngs_modulus=5e8; material.rock.poisson_ratio=0.2; material.rock.friction_angle=35; "
      "material.rock.cohesion=1e6; body.block.min=[4,40]; body.block.max=[8,44]; body.block.porosity=0.1; "
      "body.right.material=ice; body.right.shape=polygon; body.right.vertices=[[20,40],[28,40],[20,48]]; "
      "body.right.porosity=0.9; body.right.temperature={depth=[0,4],value=[-2,-6]}; heat.enabled=true; "
      "pressure.enabled=true";
  Simulation<2> simulation(published_case("free", two));
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
