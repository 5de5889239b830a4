// A section whose width varies along x: balances, equilibrium, areas and thicknesses, and exact strain.
#include "mpm/section_width.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "../support/column_slab.hpp"
#include "../support/fields.hpp"
#include "../support/messages.hpp"
#include "sim/block/block.hpp"
#include "sim/checks/body_figures.hpp"
#include "sim/records/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

TEST(SectionWidth, IsLinearBetweenPlacesAndConstantBeyond) {
  const mpm::SectionWidth width(Table({100.0, 200.0, 250.0}, {20.0, 60.0, 30.0}), 50.0);
  for (const auto& [x, relative, widening] : {std::tuple(0.0, 1.0, 0.0),
                                              {50.0, 1.0, 0.02},
                                              {75.0, 1.5, 0.02 / 1.5},
                                              {150.0, 3.0, -0.03 / 3.0},
                                              {200.0, 1.5, 0.0},
                                              {1e6, 1.5, 0.0}}) {
    EXPECT_DOUBLE_EQ(width.at(x), relative) << x;
    EXPECT_DOUBLE_EQ(width.view().widening(x), widening) << x;
  }
  EXPECT_FALSE(mpm::SectionWidth().varies());
  EXPECT_EQ(mpm::SectionWidth().at(7.0), 1.0);
}

// A uniform table uses every step of a varying one, with factors of 1.
void expect_bits_of_one_width(const Sets& sets) {
  const auto run = [&](const char* width) {
    auto simulation = std::make_unique<Simulation<2>>(case_from_text(column_slab(), sets + width));
    run_until(*simulation, 1.0);
    return simulation;
  };
  const auto one = run("case.width=617.0"),
             table = run("case.width={ x = [20.0, 50.0, 90.0], value = [617.0, 617.0, 617.0] }");
  EXPECT_FALSE(one->model().motion.width.varies());
  EXPECT_TRUE(table->model().motion.width.varies());
  expect_the_same_state(state_of(*one), state_of(*table), "a constant table");
  const HistoryRow row = history_row(*one), of_table = history_row(*table);
  for (std::size_t k = 0; k < row.size(); ++k) {
    EXPECT_TRUE(row[k].second == of_table[k].second || std::isnan(row[k].second)) << row[k].first;
  }
  EXPECT_GT(std::abs(value_of(row, "friction_work_J")), 1e6) << "it slides";
}

TEST(SectionWidth, OfAUniformTableIsBitwiseIdenticalToANumber) {
  expect_bits_of_one_width({});
  expect_bits_of_one_width("band.model=scaled; pressure.frozen_rows=vented");
  expect_bits_of_one_width("mechanics.transfer=apic");
}

// Elastic material under its weight between sides of the domain, in a section that widens, narrows and widens again.
const Variant basin{
    "free",
    "case.gravity=9.81; case.width={x=[20,60,80,90],value=[10,50,20,25]}; time.end=0.2; time.step=0.001; "
    "grid.cell=2.5; grid.max=[100,30]; grid.boundary.x_min=roller; grid.boundary.x_max=roller; "
    "grid.boundary.y_min=roller; material.rock.poisson_ratio=0.3; body.block.min=[0,0]; body.block.max=[100,20]; "
    "mechanics.initial_stress=geostatic"};

TEST(SectionWidth, LeavesHydrostaticStressInEquilibrium) {
  Simulation<2> simulation(case_from_text(basin));
  double fastest = 0.0, along = 0.0;
  for (int k = 0; k < 200; ++k) {
    simulation.step(0.001);
    for (std::size_t p = 0; p < simulation.particles().size(); ++p) {
      along = std::max(along, std::abs(simulation.particles().velocity(p, 0)));
      fastest = std::max(fastest, std::abs(simulation.particles().velocity(p, 1)));
    }
  }
  // K0 rho g (b'/b) h/2 over rho is 4.2 m/s2 on average at the narrow end: 0.8 m/s after 0.2 s without the walls.
  EXPECT_LT(along, 1e-9);
  EXPECT_LT(fastest, 0.01);
  const HistoryRow row = history_row(simulation);
  EXPECT_NEAR(value_of(row, "momentum_residual_x_N_s"), 0.0, 1e-6);
  EXPECT_GT(std::abs(value_of(row, "ground_impulse_x_N_s")), 1e6) << "of the walls";
}

TEST(SectionWidth, ScalesTheVolumeOfTheSection) {
  Simulation<2> simulation(case_from_text(basin));
  const double density = simulation.particles().mass(0) / simulation.particles().volume(0);
  // 20 m high; trapezoids of the table, over the first width of 10 m.
  const double volume = 20.0 * (20.0 * 10.0 + 40.0 * 30.0 + 20.0 * 35.0 + 10.0 * 22.5 + 10.0 * 25.0) / 10.0;
  EXPECT_NEAR(simulation.sum_over_body().initial_volume, volume, 1e-9 * volume);
  EXPECT_NEAR(value_of(history_row(simulation), "mass_kg"), 10.0 * density * volume, 1e-9 * 10.0 * density * volume)
      << "of all the width";
  const BodyFigures figures = body_figures(simulation).at(0);
  EXPECT_NEAR(figures.mean_thickness, 20.0, 1e-9);
  EXPECT_NEAR(figures.largest_thickness, 20.0, 1e-9);
  EXPECT_NEAR(figures.shape_volume, volume, 1e-9 * volume) << "no warning of its volume";
  EXPECT_LT(figures.clearance, 1e-9);
}

// Nodal velocities u = a (x, 0) in a section b = x: with r = x the expansion of a cylinder, whose two strains are
// equal.
TEST(SectionWidth, StrainsLikeAnExpandingCylinder) {
  constexpr double a = 2.0, dt = 0.001;
  Simulation<2> simulation(
      case_from_text(basin,
                     "case.width={ x = [10.0, 1000.0], value = [10.0, 1000.0] }; body.block.min=[20.0, 0.0]; "
                     "mechanics.initial_stress=none; grid.boundary.x_min=open; grid.boundary.x_max=open; "
                     "grid.boundary.y_min=open"));
  mpm::Particles<2>& particles = simulation.particles();
  mpm::Nodes<2> nodes;
  const auto& model = simulation.model().motion;
  mpm::SparseGrid<2> grid(2.5);
  grid.update(particles, 0);
  mpm::momentum_to_grid(grid, particles, model, nodes);
  nodes.velocity.resize(grid.blocks().size());
  for (std::size_t b = 0; b < grid.blocks().size(); ++b) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<2>::nodes); ++k) {
      nodes.velocity(b, k)[0] = a * mpm::node_position(grid, b, k)[0];
      nodes.velocity(b, k)[1] = 0.0;
    }
  }
  for (std::size_t p = 0; p < particles.size(); ++p) {
    particles.step_displacement(p, 0) = dt * a * particles.position(p, 0);
    particles.step_displacement(p, 1) = 0.0;
  }
  mpm::update_stress_and_porosity(grid, particles, model, dt, nodes);
  const double strain = a * dt / (1.0 + 0.5 * a * dt), lame = 1e8 * 0.3 / (1.3 * 0.4), shear = 1e8 / 2.6;
  const double ratio = (1.0 + a * dt) * (1.0 + a * dt);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    EXPECT_NEAR(particles.stress(p, 0), 2.0 * (lame + shear) * strain, 1e-12 * lame);
    EXPECT_NEAR(particles.stress(p, 2), 2.0 * (lame + shear) * strain, 1e-12 * lame);
    EXPECT_NEAR(particles.stress(p, 1), 2.0 * lame * strain, 1e-12 * lame);
    EXPECT_NEAR(particles.volume(p) / particles.initial_volume(p), ratio, 1e-12);
  }
}

// Sand moving through a section that widens and narrows: momentum closes to round-off, mass exactly, and energy as well
// as with a constant width.
const Variant channel{
    "sand",
    "case.width={x=[60,110,140,170],value=[20,60,60,40]}; case.gravity_tilt=10; time.end=4; time.step=0.002; "
    "grid.cell=1.25; grid.max=[300,30]; grid.boundary.x_min=open; body.column.min=[10,0]; body.column.max=[50,5]; "
    "body.column.velocity=[25,0]"};

struct Closing {
  double momentum, mass, energy;  // relative residuals
};

Closing closing(const Sets& sets) {
  Simulation<2> simulation(case_from_text(channel, sets));
  run_until(simulation, 4.0);
  const HistoryRow row = history_row(simulation);
  const double turned = value_of(row, "friction_work_J") + value_of(row, "plastic_J");
  return {std::hypot(value_of(row, "momentum_residual_x_N_s"), value_of(row, "momentum_residual_y_N_s")) /
              value_of(row, "momentum_x_N_s"),
          value_of(row, "mass_residual_kg") / value_of(row, "mass_kg"),
          std::abs(value_of(row, "mechanical_residual_J")) / turned};
}

TEST(SectionWidth, ClosesTheBalances) {
  for (const Sets transfer : {"", "mechanics.transfer=apic", "mechanics.transfer=fmpm; mechanics.fmpm_interval=0.1"}) {
    const Closing coarse = closing(transfer), fine = closing(transfer + "time.step=0.001");
    EXPECT_LT(coarse.energy, 0.002);
    EXPECT_LT(fine.energy, 0.6 * coarse.energy) << "of first order in the step";
    for (const Closing& of : {coarse, fine}) {
      EXPECT_LT(of.momentum, 1e-11);
      EXPECT_EQ(of.mass, 0.0);
    }
  }
}

// Columns of a slab have its thickness, regardless of the width of the section.
TEST(SectionWidth, DoesNotChangeTheFlowDepth) {
  const Sets scaled = "band.model=scaled; case.gravity_tilt=0.0";
  const Simulation<2> same(case_from_text(column_slab(), scaled));
  const Simulation<2> simulation(
      case_from_text(column_slab(), scaled + "case.width={ x = [20.0, 180.0], value = [10.0, 50.0] }"));
  for (std::size_t p = 0; p < same.particles().size(); ++p) {
    EXPECT_NEAR(simulation.particles().flow_depth(p), same.particles().flow_depth(p), 1e-9);
  }
}

// The ground under a resting slab has the area of the section with its width, and carries the weight.
TEST(SectionWidth, DoesNotChangeTheLoadPerArea) {
  const Sets rests =
      "case.width={ x = [20.0, 180.0], value = [10.0, 50.0] }; case.gravity_tilt=0; body.slab.velocity=[0,0]; "
      "material.rock.viscosity_time=0.1";
  Simulation<2> simulation(case_from_text(column_slab(), rests));
  run_until(simulation, 3.0);
  const double area = (20.0 * 10.0 + 160.0 * 30.0 + 20.0 * 50.0) / 10.0;  // per metre of the first 10 m
  const HistoryRow row = history_row(simulation);
  EXPECT_NEAR(simulation.contact().area, area, 0.03 * area);
  EXPECT_NEAR(value_of(row, "base_area_m2"), 10.0 * area, 0.06 * 10.0 * area);
  const double weight = 9.81 * value_of(row, "mass_kg");
  EXPECT_NEAR(value_of(row, "basal_force_y_N"), -weight, 0.02 * weight);
  EXPECT_NEAR(value_of(row, "band_normal_pressure_Pa"), weight / (10.0 * area), 0.04 * weight / (10.0 * area));
  EXPECT_NEAR(value_of(row, "seismic_force_x_N"), 0.0, 1e-3 * weight);
}

TEST(SectionWidth, ConservesHeatAndWaterOfBandColumns) {
  Simulation<2> simulation(
      case_from_text(column_slab(),
                     "case.width={ x = [100.0, 300.0, 400.0], value = [10.0, 50.0, 20.0] }; "
                     "body.slab.velocity=[30.0, 0.0]; material.rock.law=mohr_coulomb; material.rock.cohesion=1e4; "
                     "material.rock.friction_angle=30.0"));
  while (simulation.time() < 6.0 - 1e-9) {
    simulation.step(simulation.next_step(6.0));
    const HistoryRow row = history_row(simulation);
    const double heat = value_of(row, "friction_heat_J");
    ASSERT_LT(std::abs(value_of(row, "thermal_residual_J")), 1e-10 * (heat + std::abs(value_of(row, "column_heat_J"))));
    ASSERT_LT(std::abs(value_of(row, "column_water_residual_kg")), 1e-12 * value_of(row, "column_water_kg"));
  }
  const double covered = simulation.contact().area;
  EXPECT_NEAR(value_of(history_row(simulation), "base_area_m2"), 10.0 * covered, 0.1 * 10.0 * covered);
  EXPECT_GT(value_of(history_row(simulation), "front_position_m"), 320.0) << "it has passed the widest place";
}

TEST(SectionWidth, IsRefusedByTheBlock) {
  const config::Case parameters = case_from_text(column_slab(), {"case.width={ x = [0.0, 9.0], value = [1.0, 2.0] }"});
  expect_in(error_of([&] { run_block(parameters); }),
            "the block model has one width. Give case.width as a number, or use `thawslide run`.");
}

}  // namespace
}  // namespace thawslide::sim
