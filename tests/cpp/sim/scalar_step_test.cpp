// The step in batches against the same step particle by particle (tests/cpp/support/scalar_step.hpp), and the bits of
// the full model whatever the threads and the order in memory.
#include "../support/scalar_step.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "../support/case_from_text.hpp"
#include "../support/fields.hpp"
#include "base/parallel.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

// Two bodies on a slope, one frozen and one melted, with every mechanism; every body has its own particle size and its
// own count of particles a cell, so that batches fall out of step with nodes.
template <int Dim>
config::Case two_bodies(double cohesion) {
  const auto at = [](double x, double z) {
    return Dim == 2 ? fmt::format("[{}, {}]", x, z) : fmt::format("[{}, {}, {}]", x, z > 0.0 ? 3.0 : 0.0, z);
  };
  return case_from_text(fmt::format(R"(
[case]
dimension = {}
gravity_tilt = 35.0
[time]
end = 10.0
step = 0.002
[grid]
cell = 1.0
min = {}
max = {}
[terrain]
type = "flat"
elevation = 0.0
[material.frozen]
law = "mohr_coulomb"
youngs_modulus = 2e8
poisson_ratio = 0.3
friction_angle = 35.0
cohesion = {}
hydraulic_conductivity = 1e-9
[material.melted]
law = "mohr_coulomb"
youngs_modulus = 1e8
poisson_ratio = 0.2
friction_angle = 30.0
cohesion = {}
residual_cohesion = {}
tension_cutoff = 1e5
hydraulic_conductivity = 1e-10
[body.left]
material = "frozen"
min = {}
max = {}
temperature = -0.5
porosity = 0.375
[body.right]
material = "melted"
min = {}
max = {}
temperature = 1.5
porosity = 0.3
particles_per_axis = 3
[basal]
friction = "lubricated"
friction_angle = 25.0
[band]
thickness = 0.1
)",
                                    Dim, Dim == 2 ? "[-4.0, -4.0]" : "[-4.0, -4.0, -4.0]",
                                    Dim == 2 ? "[40.0, 20.0]" : "[40.0, 10.0, 20.0]", cohesion, cohesion,
                                    0.5 * cohesion, at(0.0, 0.0), at(7.0, 5.0), at(7.0, 0.0), at(11.3, 4.1)));
}

// The largest difference of `of` between particles, over its largest size.
template <int Dim, class Of>
double difference(const std::vector<Point<Dim>>& batched, const std::vector<Point<Dim>>& scalar, const Of& of) {
  double largest = 0.0, size = 0.0;
  for (std::size_t p = 0; p < batched.size(); ++p) {
    const double here = std::abs(of(batched[p]) - of(scalar[p]));
    EXPECT_TRUE(std::isfinite(here)) << p << ": " << of(batched[p]) << ", " << of(scalar[p]);
    largest = std::max(largest, here);
    size = std::max(size, std::abs(of(scalar[p])));
  }
  return size > 0.0 ? largest / size : largest;
}

// Components `first` ... of the records of the nodes that filled(block, node) names.
template <class Records, int Dim, class Filled>
void expect_same_sums(const Records& records, const ScalarStep<Dim>& scalar, const typename ScalarStep<Dim>::Sums& sums,
                      std::size_t first, const Filled& filled) {
  std::vector<double> largest(sums.begin()->second.size(), 0.0), size = largest;
  std::size_t count = 0;
  for (const auto& [node, sum] : sums) {
    const auto [b, k] = scalar.at(node);
    if (!filled(b, k)) {
      continue;
    }
    ++count;
    for (std::size_t c = 0; c < sum.size(); ++c) {
      largest[c] = std::max(largest[c], std::abs(records(b, k)[first + c] - sum[c]));
      size[c] = std::max(size[c], std::abs(sum[c]));
    }
  }
  EXPECT_GT(count, 10u);
  for (std::size_t c = 0; c < size.size(); ++c) {
    EXPECT_LE(largest[c], 1e-12 * size[c]) << "component " << c;
  }
}

template <int Dim>
void expect_the_scalar_step(double cohesion, bool yields) {
  constexpr double tolerance = 1e-12, dt = 0.002;
  Simulation<Dim, double> simulation(two_bodies<Dim>(cohesion));
  for (int k = 0; k < 60; ++k) {
    simulation.step(dt);
  }
  const auto before = points_of(simulation);
  simulation.step(dt);
  const ScalarStep<Dim> scalar(simulation, dt, before);
  const auto now = points_of(simulation);
  const auto every_node = [](std::size_t /*block*/, std::size_t /*node*/) { return true; };
  expect_same_sums(simulation.nodes().momentum, scalar, scalar.momentum(), 0, every_node);
  expect_same_sums(simulation.nodes().hats, scalar, scalar.hats(), 0, every_node);
  const auto candidates = [&](std::size_t b, std::size_t k) { return simulation.ground()->block(b)[k].candidate; };
  expect_same_sums(simulation.nodes().near_base, scalar, scalar.near_base_by_mass(), 0, candidates);
  expect_same_sums(simulation.nodes().near_base, scalar, scalar.near_base_by_hats(),
                   mpm::NearBaseLayout::saturation_by_hats, candidates);
  for (const auto& [node, momentum] : scalar.mapped()) {
    const auto [b, k] = scalar.at(node);
    const double mass = simulation.nodes().momentum(b, k)[mpm::MomentumLayout<Dim>::mass];
    for (std::size_t a = 0; a < Dim && simulation.nodes().contact(b, k)[mpm::ContactLayout::touching] == 0.0; ++a) {
      EXPECT_NEAR(mass * simulation.nodes().velocity(b, k)[a], momentum[a], tolerance * 1e6);
    }
  }
  using P = Point<Dim>;
  const auto expect_same = [&](const char* name, const auto& of) {
    EXPECT_LE((difference<Dim>(now, scalar.points(), of)), tolerance) << name;
  };
  for (int a = 0; a < Dim; ++a) {
    expect_same("velocity", [a](const P& p) { return p.velocity[a]; });
    expect_same("displacement", [a](const P& p) { return p.displacement[a]; });
  }
  for (int c = 0; c < 6; ++c) {
    expect_same("stress", [c](const P& p) { return p.stress[c]; });
  }
  expect_same("plastic strain", [](const P& p) { return p.plastic_strain; });
  expect_same("volume", [](const P& p) { return p.volume; });
  expect_same("porosity", [](const P& p) { return p.porosity; });
  expect_same("temperature", [](const P& p) { return p.temperature; });
  expect_same("heat content", [](const P& p) { return p.heat_content; });
  expect_same("saturation", [](const P& p) { return p.saturation; });
  auto drained = scalar.points();
  for (std::size_t p = 0; p < now.size(); ++p) {
    if (now[p].pore_pressure == 0.0) {
      drained[p].pore_pressure = 0.0;  // at the surface
    }
  }
  EXPECT_LE((difference<Dim>(now, drained, [](const P& p) { return p.pore_pressure; })), tolerance);
  std::size_t yielding = 0, warmed = 0;
  for (std::size_t p = 0; p < now.size(); ++p) {
    yielding += now[p].plastic_strain > before[p].plastic_strain ? 1 : 0;
    warmed += now[p].temperature != before[p].temperature ? 1 : 0;
  }
  EXPECT_EQ(yielding > now.size() / 20, yields) << yielding << " of " << now.size();
  EXPECT_GT(warmed, now.size() / 20);
  // Tiles whose temperatures change and tiles whose do not, which spare themselves the secant capacity.
  const auto& changing = simulation.heat_nodes().changing_tiles;
  const auto count = std::count(changing.begin(), changing.end(), 1);
  EXPECT_GT(count, 0);
  EXPECT_LT(static_cast<std::size_t>(count), changing.size());
}

TEST(ScalarStep, IsThatOfTheBatchesInThePlaneElastic) { expect_the_scalar_step<2>(1e7, false); }
TEST(ScalarStep, IsThatOfTheBatchesInThePlaneYielding) { expect_the_scalar_step<2>(5e3, true); }
TEST(ScalarStep, IsThatOfTheBatchesInSpaceElastic) { expect_the_scalar_step<3>(1e7, false); }
TEST(ScalarStep, IsThatOfTheBatchesInSpaceYielding) { expect_the_scalar_step<3>(5e3, true); }

// Every field of every particle after some steps, by name and in order of id.
template <int Dim, class Real = double>
std::map<std::string, std::vector<double>> fields_after(int steps, int threads, int sorting_interval,
                                                        double cohesion = 5e3) {
  set_thread_count(threads);
  Simulation<Dim, Real> simulation(two_bodies<Dim>(cohesion));
  simulation.set_sorting_interval(sorting_interval);
  for (int k = 0; k < steps; ++k) {
    simulation.step(0.002);
  }
  return fields_by_id(simulation.particles());
}

template <int Dim>
void expect_the_same_bits(int steps) {
  const int before = thread_count();
  const auto first = fields_after<Dim>(steps, 1, 0);
  for (const auto& [threads, interval] : {std::pair(1, 1), std::pair(2, 7), std::pair(3, 64), std::pair(4, 3)}) {
    EXPECT_TRUE((fields_after<Dim>(steps, threads, interval) == first))
        << threads << " threads, sorted every " << interval << " steps";
  }
  set_thread_count(before);
}

TEST(Bits, DependNeitherOnThreadsNorOnSortingInThePlane) { expect_the_same_bits<2>(80); }
TEST(Bits, DependNeitherOnThreadsNorOnSortingInSpace) { expect_the_same_bits<3>(15); }

#ifndef THAWSLIDE_DOUBLE_ONLY

// The largest difference that single precision makes to a field, over the field's largest size.
template <int Dim>
void expect_of_single_precision(int steps, const std::map<std::string, double>& allowed) {
  constexpr double elastic = 1e7;
  const int threads = thread_count();
  const auto in_double = fields_after<Dim>(steps, threads, 64, elastic);
  const auto in_single = fields_after<Dim, float>(steps, threads, 64, elastic);
  for (const auto& [name, most] : allowed) {
    const auto& exact = in_double.at(name);
    double largest = 0.0, size = 0.0;
    for (std::size_t k = 0; k < exact.size(); ++k) {
      largest = std::max(largest, std::abs(in_single.at(name)[k] - exact[k]));
      size = std::max(size, std::abs(exact[k]));
    }
    EXPECT_LE(largest, most * size) << name << " after " << steps << " steps";
  }
}

// In one step some ten digits' ends, and what undrained heating makes of those of the temperature. Then differences of
// positions about a cell lose digits to their distance from the origin, and stress shows it first.
TEST(SinglePrecision, IsAsFarFromDoubleAsItsDigits) {
  const std::map<std::string, double> in_one_step{{"velocity", 5e-6}, {"displacement", 5e-6},
                                                  {"stress", 5e-6},   {"temperature", 5e-6},
                                                  {"porosity", 5e-6}, {"pore_pressure", 5e-5}};
  expect_of_single_precision<2>(1, in_one_step);
  expect_of_single_precision<3>(1, in_one_step);
  const std::map<std::string, double> in_many{{"velocity", 1e-2},    {"displacement", 1e-3}, {"stress", 3e-2},
                                              {"temperature", 1e-3}, {"porosity", 1e-3},     {"pore_pressure", 5e-3}};
  expect_of_single_precision<2>(200, in_many);
}

#endif

}  // namespace
}  // namespace thawslide::sim
