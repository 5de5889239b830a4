// Water of melted pores: uptake by frozen material, voids left by melting, water driven out by load and heat, seepage.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "../support/base_cases.hpp"
#include "../support/fields.hpp"
#include "physics/pressurization.hpp"
#include "sim/records/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

// A column of two cells by twenty whose particles are at rest.
const Variant column{"column", "phases.rock_expansion=0"};
const Sets still = "heat.enabled=false";

// Assigns another temperature to particles as their initial temperature.
void set_temperature(Simulation<2>& simulation, std::size_t p, double temperature) {
  auto& particles = simulation.particles();
  particles.temperature(p) = particles.previous_temperature(p) = temperature;
  particles.liquid_saturation(p) = simulation.model().band.with_heat_content(
      [&](const auto& content) { return content.curve.saturation(temperature); });
}

// Sum of n V/K_L P of melted material [m3], which seepage conserves.
double stored(const Simulation<2>& simulation) {
  const auto& particles = simulation.particles();
  double sum = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    sum += particles.temperature(p) >= 0.0
               ? particles.porosity(p) * particles.volume(p) / 1e9 * particles.pore_pressure(p)
               : 0.0;
  }
  return sum;
}

// Patches of frozen and melted material at random pressures, with a frozen top; minimum and maximum pressure of the
// melted ones.
void fill_with_patches(Simulation<2>& simulation) {
  auto& particles = simulation.particles();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> fraction(0.0, 1.0);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const bool frozen = fraction(random) < 0.5 || particles.position(p, 1) > 9.0;
    set_temperature(simulation, p, frozen ? -2.0 : 5.0);
    particles.liquid_pressure(p) = particles.pore_pressure(p) = frozen ? 0.0 : 2e6 * fraction(random);
    for (int a = 0; a < 2; ++a) {  // for different positions of particles in their cells
      particles.position(p, a) += 0.1 * (fraction(random) - 0.5);
    }
  }
}

// The step limit is 2.3 s.
TEST(FrozenRows, SealedOnesKeepTheWaterAndBoundItsPressure) {
  for (const double step : {0.05, 2.2}) {
    Simulation<2> simulation(
        paper_case(column, still + fmt::format("pressure.frozen_rows=sealed; time.end=1000; time.step={}", step)));
    const auto& particles = simulation.particles();
    fill_with_patches(simulation);
    const double before = stored(simulation);
    for (int k = 0; k < 200; ++k) {
      simulation.step(step);
      for (std::size_t p = 0; p < particles.size(); ++p) {
        ASSERT_TRUE(particles.temperature(p) < 0.0 ||
                    (particles.pore_pressure(p) >= 0.0 && particles.pore_pressure(p) <= 2e6))
            << particles.pore_pressure(p) << " Pa in step " << k;
      }
    }
    const auto row = history_row(simulation);
    EXPECT_NEAR(stored(simulation) / before, 1.0, 1e-12);
    EXPECT_EQ(value_of(row, "vented_water_kg"), 0.0);
    EXPECT_EQ(value_of(row, "drained_water_kg"), 0.0);
    EXPECT_NEAR(value_of(row, "seepage_residual_kg") / (1000.0 * before), 0.0, 1e-12);
  }
}

TEST(FrozenRows, SealedOnesExertNoPressureOnAdjacentWater) {
  // Melted at 1 MPa below 5 m, frozen above, with ice at any pressure: nothing flows.
  Simulation<2> simulation(paper_case(column, still + "pressure.frozen_rows=sealed"));
  auto& particles = simulation.particles();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const bool frozen = particles.position(p, 1) > 5.0;
    set_temperature(simulation, p, frozen ? -2.0 : 5.0);
    particles.liquid_pressure(p) = particles.pore_pressure(p) = frozen ? 3e5 : 1e6;
  }
  run_until(simulation, 5.0);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (particles.temperature(p) >= 0.0) {
      EXPECT_NEAR(particles.pore_pressure(p), 1e6, 1e-6);
    }
  }
}

// The uptake of frozen rows equals the loss of the melted material; vented rows absorb more than those with ice
// pressure.
TEST(FrozenRows, TheirUptakeIsCounted) {
  const auto entrained = [&](const std::string& rows) {
    Simulation<2> simulation(paper_case(column, still + ("pressure.frozen_rows=" + rows)));
    fill_with_patches(simulation);
    const double before = stored(simulation);
    run_until(simulation, 1.0);
    const auto row = history_row(simulation);
    const double vented = value_of(row, "vented_water_kg");
    EXPECT_NEAR(vented / (1000.0 * (before - stored(simulation))), 1.0, 1e-11) << rows;
    EXPECT_NEAR(value_of(row, "seepage_residual_kg") / vented, 0.0, 1e-11) << rows;
    EXPECT_NEAR((value_of(row, "pore_water_kg") - value_of(row, "water_kg")) / -vented, 1.0, 1e-11) << rows;
    return vented / (1000.0 * before);
  };
  EXPECT_GT(entrained("draining"), 0.05);
  EXPECT_GT(entrained("vented"), entrained("draining"));
  EXPECT_LT(entrained("vented"), 1.0);
}

// A melted column under 1 MPa drains at its top, where all lost water leaves.
TEST(Drainage, IsCountedAtTheSurface) {
  Simulation<2> simulation(paper_case(column, still));
  auto& particles = simulation.particles();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    particles.liquid_pressure(p) = particles.pore_pressure(p) = 1e6;
  }
  const double before = stored(simulation);
  run_until(simulation, 20.0);
  const auto row = history_row(simulation);
  EXPECT_NEAR(value_of(row, "drained_water_kg") / (1000.0 * (before - stored(simulation))), 1.0, 1e-11);
  EXPECT_GT(value_of(row, "drained_water_kg"), 0.05 * 1000.0 * before);
  EXPECT_EQ(value_of(row, "vented_water_kg"), 0.0);
  EXPECT_NEAR(value_of(row, "seepage_residual_kg") / (1000.0 * before), 0.0, 1e-12);
  EXPECT_EQ(value_of(row, "gravity_impulse_y_N_s"), 0.0) << "nothing moves";
}

// Warms or cools all material to a temperature [C] within a step; the heat for this is not counted.
void bring_to(Simulation<2>& simulation, double temperature) {
  auto& particles = simulation.particles();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double before = particles.temperature(p);
    set_temperature(simulation, p, temperature);
    particles.previous_temperature(p) = before;
  }
  simulation.step(0.05);
}

const Sets weightless = "heat.enabled=false; pressure.seepage=false; case.gravity=0.0";
constexpr double porosity = 0.375, storage = porosity / 1e9;

TEST(MeltContraction, ExpansionFillsTheVoidBeforePressureRises) {
  Simulation<2> simulation(
      paper_case(column, weightless + "pressure.melt_contraction=true; body.column.temperature=-10.0"));
  const auto& particles = simulation.particles();
  const double left = porosity * 0.083 * (1.0 - std::pow(11.0, -5.0));
  int open = 0, full = 0;
  const auto expect_at = [&](double temperature) {
    bring_to(simulation, temperature);
    const double surplus = porosity * 2.75e-4 * temperature - left;
    EXPECT_NEAR(particles.pore_pressure(7), std::max(0.0, surplus) / storage, 1e-5) << temperature;
    EXPECT_NEAR(particles.pore_void(7), std::max(0.0, -surplus), 1e-14) << temperature;
    const double volume = 10.0;
    EXPECT_NEAR(value_of(history_row(simulation), "pore_void_m3"), std::max(0.0, -surplus) * volume, 1e-12);
    (surplus < 0.0 ? open : full) += 1;
  };
  EXPECT_EQ(value_of(history_row(simulation), "pore_void_m3"), 0.0);
  bring_to(simulation, -0.5);  // most of the pore water
  const double melted = std::pow(1.5, -5.0) - std::pow(11.0, -5.0);
  EXPECT_NEAR(value_of(history_row(simulation), "pore_void_m3"), porosity * 0.083 * melted * 10.0, 1e-12);
  for (const double temperature : {0.1, 3.0, 80.0, 250.0, 301.0, 302.0, 350.0, 400.0, 310.0, 200.0, 1.0}) {
    expect_at(temperature);
  }
  bring_to(simulation, -3.0);  // frozen and thawed again
  expect_at(2.0);
  expect_at(330.0);
  EXPECT_GT(open, 5);
  EXPECT_GT(full, 4);
}

TEST(MeltContraction, WithoutItMeltIsPressurizedFromTheFirstKelvin) {
  Simulation<2> simulation(
      paper_case(column, weightless + "body.column.temperature=-10.0; pressure.skeleton_compressibility=0"));
  bring_to(simulation, 2.0);
  EXPECT_NEAR(simulation.particles().pore_pressure(7), 2.0 * 275000.0, 1e-6);
  EXPECT_FALSE(simulation.particles().pore_void.is_kept());
}

// Integral of the expansion of water from 0 C: below 0 up to 10 C, where it is as dense as at 0 C.
TEST(WaterExpansion, DependingOnTemperatureContractsFirst) {
  for (const double compressibility : {0.0, 2e-9}) {
    Simulation<2> simulation(paper_case(
        column, weightless + fmt::format("phases.water_expansion_law=by_temperature; body.column.temperature=1e-9; "
                                         "pressure.skeleton_compressibility={}",
                                         compressibility)));
    const auto& particles = simulation.particles();
    const auto expect_at = [&](double temperature, double swelling) {
      bring_to(simulation, temperature);
      const double surplus = porosity * swelling;
      EXPECT_NEAR(particles.pore_pressure(7), std::max(0.0, surplus) / (storage + compressibility), 1e-3)
          << temperature;
      EXPECT_NEAR(particles.pore_void(7), std::max(0.0, -surplus), 1e-12) << temperature;
    };
    expect_at(5.0, -1.75e-4);
    expect_at(20.0, 14e-4);
    expect_at(100.0, 417e-4);
    expect_at(50.0, 114.5e-4);
  }
}

TEST(FrozenPressure, NoneGivesThawedWaterTheLoadMinusTheResidualStress) {
  const Sets none = "heat.enabled=false; pressure.seepage=false; pressure.frozen=none; body.column.temperature=-1";
  const double density = 0.625 * 2750.0 + porosity * (1000.0 / 32.0 + 917.0 * 31.0 / 32.0);
  const auto expect_start = [&](const Sets& sets, double residual, double gas_void) {
    Simulation<2> simulation(paper_case(column, none + sets));
    const auto& particles = simulation.particles();
    for (std::size_t p = 0; p < particles.size(); ++p) {
      EXPECT_EQ(particles.pore_pressure(p), 0.0);
      EXPECT_NEAR(particles.normal_load(p), density * 9.81 * (10.0 - particles.position(p, 1)), 1e-6);
    }
    bring_to(simulation, -0.1);
    EXPECT_EQ(particles.pore_pressure(0), 0.0);
    bring_to(simulation, 0.0);
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const double start = std::max(0.0, particles.normal_load(p) - residual);
      const double allowed = storage + simulation.model().band.skeleton_compressibility;
      EXPECT_NEAR(particles.pore_pressure(p), std::max(0.0, start - gas_void / allowed), 1e-6);
    }
  };
  const double all = porosity * 0.083 * 31.0 / 32.0;
  expect_start({}, HUGE_VAL, 0.0);
  expect_start({"pressure.residual_stress=0.0"}, 0.0, 0.0);
  expect_start({"pressure.residual_stress=5e4"}, 5e4, 0.0);
  expect_start("pressure.residual_stress=0.0; pressure.melt_contraction=true", 0.0, all);
  expect_start(
      "pressure.residual_stress=2e4; pressure.melt_contraction=true; "
      "pressure.skeleton_compressibility=1e-6",
      2e4, all);
}

// Half of the weight of the material is removed and restored.
TEST(SkeletonCompressibility, PressureFollowsTheLoad) {
  Simulation<2> simulation(
      paper_case(column, "heat.enabled=false; pressure.seepage=false; pressure.skeleton_compressibility=2e-9"));
  auto& particles = simulation.particles();
  simulation.step(0.05);
  std::vector<double> pressure(particles.size()), load(particles.size());
  for (std::size_t p = 0; p < particles.size(); ++p) {
    pressure[p] = particles.pore_pressure(p);
    load[p] = particles.normal_load(p);
    particles.mass(p) *= 0.5;
  }
  simulation.step(0.05);
  constexpr double fraction = 2e-9 / (storage + 2e-9);
  int voids = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double now = pressure[p] - fraction * 0.5 * load[p];
    EXPECT_NEAR(particles.pore_pressure(p), std::max(0.0, now), 1e-8);
    EXPECT_NEAR(particles.pore_void(p), std::max(0.0, -now * (storage + 2e-9)), 1e-16);
    voids += now < 0.0 ? 1 : 0;
    particles.mass(p) *= 2.0;
  }
  EXPECT_EQ(voids, 0) << "P_I/r is above half of 0.84 of the load";
  simulation.step(0.05);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    EXPECT_NEAR(particles.pore_pressure(p), pressure[p], 1e-8);
  }
}

// With m_v, pores store more: heating raises pressure less, and pressure diffuses more slowly by the same factor.
TEST(SkeletonCompressibility, SlowsDiffusionByTheStorage) {
  const auto bump_after = [&](double compressibility, double time) {
    Simulation<2> simulation(
        paper_case(column, {"heat.enabled=false", "case.gravity=0.0", "pressure.melt_contraction=true",
                            fmt::format("pressure.skeleton_compressibility={}", compressibility), "time.step=0.005"}));
    auto& particles = simulation.particles();
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const double from_middle = particles.position(p, 1) - 5.0;
      particles.liquid_pressure(p) = particles.pore_pressure(p) = 1e6 * std::exp(-from_middle * from_middle / 0.8);
    }
    while (simulation.time() < time * (1.0 - 1e-9)) {
      simulation.step(time / 200.0);
    }
    return fields_by_id(particles).at("pore_pressure");
  };
  const auto rigid = bump_after(0.0, 1.0), soft = bump_after(3.0 * storage, 4.0);
  for (std::size_t p = 0; p < rigid.size(); ++p) {
    EXPECT_NEAR(soft[p], rigid[p], 1e-6 * 1e6);
  }
}

const Variant seeping{"column", "time.end=5; body.column.porosity=0.4; heat.enabled=false"};

// Pressure resolved by the nodes diffuses, unresolved pressure decreases by subgrid diffusion. Pressures that alternate
// from row to row within each cell: each node resolves their mean only.
TEST(Seepage, LevelsPressureUnresolvedByNodes) {
  Simulation<2> simulation(paper_case(seeping));
  auto& particles = simulation.particles();
  constexpr double mean = 5e5, swing = 4e5;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const auto row = static_cast<long>(std::floor(particles.position(p, 1) / 0.25));
    particles.liquid_pressure(p) = particles.pore_pressure(p) = mean + (row % 2 == 0 ? swing : -swing);
  }
  run_until(simulation, 0.5);
  // D = 1e9 x 1e-7/(0.4 x 9810) = 0.02548 m2/s; 4 D/0.25 m2 = 0.4077 1/s on the grid as it is (xi = 1).
  const double left = std::exp(-0.5 * 4.0 * 1e9 * 1e-7 / (0.4 * 9810.0) / 0.25);
  int inside = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double y = particles.position(p, 1);
    if (y > 2.0 && y < 8.0) {
      const auto row = static_cast<long>(std::floor(y / 0.25));
      EXPECT_NEAR(particles.pore_pressure(p) - mean, (row % 2 == 0 ? swing : -swing) * left, 1e-3 * swing);
      ++inside;
    }
  }
  EXPECT_EQ(inside, 96);
}

// Melted material without hydraulic conductivity keeps its water, next to permeable material and at the surface.
TEST(Seepage, DoesNotAffectImpermeableMaterial) {
  const Sets tight =
      "material.tight.law=elastic; material.tight.youngs_modulus=1e8; material.tight.poisson_ratio=0.2; "
      "body.lid.material=tight; body.lid.min=[0,10]; body.lid.max=[1,11]; body.lid.temperature=5; "
      "body.lid.porosity=0.4";
  Simulation<2> simulation(paper_case(seeping + tight));
  auto& particles = simulation.particles();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    particles.liquid_pressure(p) = particles.pore_pressure(p) = particles.material(p) == 0 ? 1e6 : 3e5;
  }
  run_until(simulation, 1.0);
  int lid = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (particles.position(p, 1) > 10.0) {
      EXPECT_EQ(particles.pore_pressure(p), 3e5) << "at " << particles.position(p, 1) << " m";
      ++lid;
    }
  }
  EXPECT_EQ(lid, 16);
}

}  // namespace
}  // namespace thawslide::sim
