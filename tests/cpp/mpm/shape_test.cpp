// Weights of shape functions: partition of unity, linear fields, slopes.
#include "mpm/shape.hpp"

#include <gtest/gtest.h>

#include <random>

namespace thawslide::mpm {
namespace {

// At random offsets, away from sides and at sides.
template <class Shape>
void expect_sound_weights(double half) {
  const double inverse_cell = 1.0 / 5.0, h = 1e-6;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> offset(-0.499, 0.499);
  for (int trial = 0; trial < 400; ++trial) {
    const double d = offset(random);
    const bool at_side = trial % 2 == 1;
    const auto w = Shape::weights(d, half, at_side, inverse_cell);
    EXPECT_NEAR(w.weight[0] + w.weight[1] + w.weight[2], 1.0, 1e-15);
    EXPECT_NEAR(w.slope[0] + w.slope[1] + w.slope[2], 0.0, 1e-15);
    EXPECT_NEAR(-w.weight[0] + w.weight[2], d, 1e-15) << "the weights' centre is the particle";
    EXPECT_NEAR(-w.slope[0] + w.slope[2], inverse_cell, 1e-15);
    if (std::abs(d) < 1e-5) {
      continue;  // the linear shape functions have a kink at their node
    }
    const auto ahead = Shape::weights(d + h, half, at_side, inverse_cell);
    const auto behind = Shape::weights(d - h, half, at_side, inverse_cell);
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(w.weight[k], 0.0);
      EXPECT_NEAR(w.slope[k], (ahead.weight[k] - behind.weight[k]) / (2 * h) * inverse_cell, 1e-5);
    }
  }
}

// Of heat, averages and pore pressure.
struct LinearWeightsAlone {
  static AxisWeights<double> weights(double offset, double /*half*/, bool /*at_side*/, double inverse_cell) {
    return linear_weights(offset, inverse_cell);
  }
};

TEST(Shape, WeightsSumToOneReproduceLinearFieldsAndMatchTheirSlopes) {
  for (const double half : {0.25, 0.125, 0.5}) {
    expect_sound_weights<Ugimp>(half);
  }
  expect_sound_weights<LinearWeightsAlone>(0.25);
  expect_sound_weights<Quadratic>(0.25);
}

TEST(Shape, QuadraticIsSmoothAcrossCellsAndIntoTheHalfCellAtASide) {
  using Spline = Quadratic;
  const auto here = Spline::weights(0.5, 0.25, false, 0.2), next = Spline::weights(-0.5, 0.25, false, 0.2);
  const auto at_side = Spline::weights(0.5, 0.25, true, 0.2);
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(here.weight[k + 1], next.weight[k], 1e-15);
    EXPECT_NEAR(here.slope[k + 1], next.slope[k], 1e-15);
    EXPECT_NEAR(at_side.weight[k + 1], next.weight[k], 1e-15);
    EXPECT_NEAR(at_side.slope[k + 1], next.slope[k], 1e-15);
  }
  EXPECT_EQ(here.weight[0], 0.0);
}

// Basis of APIC: node velocities a + b x give b, independent of a.
template <class Shape>
void expect_affine_velocity(double half) {
  for (double d = -0.499; d < 0.5; d += 0.0137) {
    for (const bool at_side : {false, true}) {
      const auto affine = Shape::affine(Shape::weights(d, half, at_side, 0.2), d, at_side, 0.2);
      EXPECT_NEAR(affine.slope[0] + affine.slope[1] + affine.slope[2], 0.0, 1e-14);
      EXPECT_NEAR(5.0 * (-affine.slope[0] + affine.slope[2]), 1.0, 1e-14);
    }
  }
}

TEST(Shape, AffineWeightsFindALinearVelocity) {
  expect_affine_velocity<Ugimp>(0.25);
  expect_affine_velocity<Ugimp>(0.125);
  expect_affine_velocity<Quadratic>(0.25);
  for (double d = -0.5; d <= 0.5; d += 0.125) {
    EXPECT_NEAR(second_moment(quadratic_weights(d, 1.0), d), 0.25, 1e-15);
    EXPECT_GE(second_moment(ugimp_weights(d, 0.25, 1.0), d), 0.125);
  }
}

TEST(Ugimp, IsTheLinearShapeFunctionAveragedOverTheParticle) {
  // Simpson's rule over the particle's width, divided at the kinks of the linear shape function.
  const double half = 0.25, d = 0.1;
  const auto linear = [](double x) { return std::max(0.0, 1.0 - std::abs(x)); };
  for (int node = -1; node <= 1; ++node) {
    double sum = 0.0;
    const int parts = 20000;
    for (int k = 0; k < parts; ++k) {
      sum += linear(d - half + 2.0 * half * (k + 0.5) / parts - node) / parts;
    }
    EXPECT_NEAR(ugimp_weights(d, half, 1.0).weight[node + 1], sum, 1e-7) << node;
  }
}

}  // namespace
}  // namespace thawslide::mpm
