// Seepage in a melted column: pressure resolved by the nodes diffuses, unresolved pressure decreases by subgrid
// diffusion, and water is conserved.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/base_cases.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

const Variant column{"column", "time.end=5; body.column.porosity=0.4; heat.enabled=false"};

// Pressures that alternate from row to row within each cell: each node resolves their mean only.
TEST(Seepage, LevelsPressureUnresolvedByNodes) {
  Simulation<2> simulation(paper_case(column));
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

// A bump far from the drained top spreads with the variance 2 D t, and its sum is constant.
TEST(Seepage, SpreadsABumpAndKeepsItsSum) {
  Simulation<2> simulation(paper_case(column));
  auto& particles = simulation.particles();
  const auto moments = [&] {
    double sum = 0.0, middle = 0.0, spread = 0.0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      sum += particles.pore_pressure(p);
      middle += particles.pore_pressure(p) * particles.position(p, 1);
    }
    for (std::size_t p = 0; p < particles.size(); ++p) {
      spread += particles.pore_pressure(p) * std::pow(particles.position(p, 1) - middle / sum, 2);
    }
    return std::pair(sum, spread / sum);
  };
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double from_middle = particles.position(p, 1) - 5.0;
    particles.liquid_pressure(p) = particles.pore_pressure(p) = 1e6 * std::exp(-from_middle * from_middle / 0.8);
  }
  const auto [sum, spread] = moments();
  run_until(simulation, 5.0);
  const auto [sum_after, spread_after] = moments();
  EXPECT_NEAR(sum_after / sum, 1.0, 1e-6);
  EXPECT_NEAR((spread_after - spread) / (2.0 * 0.025484 * 5.0), 1.0, 0.02);
}

// Melted material without hydraulic conductivity keeps its water, next to permeable material and at the surface.
TEST(Seepage, DoesNotAffectImpermeableMaterial) {
  const Sets tight =
      "material.tight.law=elastic; material.tight.youngs_modulus=1e8; material.tight.poisson_ratio=0.2; "
      "body.lid.material=tight; body.lid.min=[0,10]; body.lid.max=[1,11]; body.lid.temperature=5; "
      "body.lid.porosity=0.4";
  Simulation<2> simulation(paper_case(column + tight));
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
