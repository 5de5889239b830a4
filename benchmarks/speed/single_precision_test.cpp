// How far single precision, in which the step is compiled to be measured only, is from double.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "../../tests/cpp/support/fields.hpp"
#include "../../tests/cpp/support/two_bodies.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

constexpr double cohesion = 1e7;  // [Pa]: nothing yields

template <int Dim, class Real>
std::map<std::string, std::vector<double>> state_after(int steps) {
  Simulation<Dim, Real> simulation(two_bodies<Dim>(cohesion));
  for (int k = 0; k < steps; ++k) {
    simulation.step(0.002);
  }
  return fields_by_id(simulation.particles());
}

// The largest difference that single precision makes to a field, over the field's largest size.
template <int Dim>
void expect_of_single_precision(int steps, const std::map<std::string, double>& allowed) {
  const auto in_double = state_after<Dim, double>(steps);
  const auto in_single = state_after<Dim, float>(steps);
  for (const auto& [name, most] : allowed) {
    const auto& exact = in_double.at(name);
    double largest = 0.0, size = 0.0;
    for (std::size_t k = 0; k < exact.size(); ++k) {
      EXPECT_TRUE(std::isfinite(in_single.at(name)[k])) << name;
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

}  // namespace
}  // namespace thawslide::sim
