#include "physics/heat_content.hpp"

#include <gtest/gtest.h>

#include <random>

#include "table1.hpp"

namespace thawslide::physics {
namespace {

template <class Curve>
Curve curve();
template <>
PowerLawCurve curve() {
  return {0.0, 5.0};
}
template <>
LinearCurve curve() {
  return {0.0, 0.25};
}

template <class Curve>
class FreezingCurve : public testing::Test {};
using Curves = testing::Types<PowerLawCurve, LinearCurve>;
TYPED_TEST_SUITE(FreezingCurve, Curves);

TYPED_TEST(FreezingCurve, DerivativeAndIntegralBelongToTheSaturation) {
  const auto law = curve<TypeParam>();
  const double h = 1e-5;
  for (const double t : {-30.0, -9.3, -3.1, -1.7, -0.4, -0.01, 0.5, 12.0}) {
    const auto values = law.at(t);
    EXPECT_NEAR(values.saturation, law.saturation(t), 1e-15) << t;
    EXPECT_NEAR(values.derivative, (law.saturation(t + h) - law.saturation(t - h)) / (2 * h), 1e-6) << t;
    // Simpson's rule from 0 to t, independent of the closed form.
    const int parts = 20000;
    double sum = 0.0;
    for (int k = 0; k < parts; ++k) {
      const double a = t * k / parts, b = t * (k + 1) / parts;
      sum += (b - a) / 6.0 * (law.saturation(a) + 4.0 * law.saturation(0.5 * (a + b)) + law.saturation(b));
    }
    EXPECT_NEAR(values.integral, sum, 1e-7) << t;
  }
  EXPECT_EQ(law.saturation(0.0), 1.0);
  EXPECT_GT(law.at(0.0).derivative, 0.0) << "at the reference temperature the frozen side's slope holds";
}

TEST(PowerLawCurve, IsEquation24ForAnyExponent) {
  EXPECT_NEAR((PowerLawCurve{0.0, 5.0}.saturation(-1.0)), 1.0 / 32.0, 1e-16);
  EXPECT_NEAR((PowerLawCurve{-0.5, 2.5}.saturation(-4.5)), std::pow(5.0, -2.5), 1e-16);
  EXPECT_NEAR((PowerLawCurve{0.0, 1.0}.at(-3.0).integral), -std::log(4.0), 1e-15);
}

TEST(LinearCurve, IsSection31) {
  const LinearCurve law{0.0, 0.5};
  EXPECT_DOUBLE_EQ(law.saturation(-1.0), 0.5);
  EXPECT_DOUBLE_EQ(law.saturation(-2.5), 0.0);
}

TYPED_TEST(FreezingCurve, TemperatureInvertsHeatContent) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> temperature(-40.0, 60.0), porosity(0.02, 0.9), offset(-60.0, 60.0);
  for (const bool latent : {true, false}) {
    const HeatContent<TypeParam> content{table1(), curve<TypeParam>(), latent};
    double worst = 0.0;
    for (int k = 0; k < 20000; ++k) {
      const double t = temperature(random), n = porosity(random);
      // From a distant initial guess: convexity ensures convergence.
      worst = std::max(worst, std::abs(content.temperature(content.content(t, n), n, t + offset(random)) - t));
    }
    EXPECT_LT(worst, 1e-10) << "latent " << latent;
    EXPECT_EQ(content.temperature(content.content(0.0, 0.4), 0.4, -3.0), 0.0);
  }
}

TYPED_TEST(FreezingCurve, HeatContentRisesWithTheApparentCapacity) {
  const HeatContent<TypeParam> content{table1(), curve<TypeParam>(), true};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> temperature(-3.9, 20.0);
  for (int k = 0; k < 2000; ++k) {
    const double t = temperature(random);
    if (std::abs(t) < 1e-2) {
      continue;
    }
    const double h = 1e-5;
    const double slope = (content.content(t + h, 0.375) - content.content(t - h, 0.375)) / (2 * h);
    EXPECT_NEAR(content.apparent_capacity(t, 0.375) / slope, 1.0, 1e-6) << t;
    EXPECT_NEAR(content.secant_capacity(t, 1e-4, 0.375) / slope, 1.0, 4e-4) << t;
    EXPECT_GT(slope, 0.0);
  }
}

TEST(HeatContent, MeltingUsesTheHeatThatSection32Omits) {
  // From -10 C to wholly melted at 0 C at a porosity of 0.375: 136.7 MJ/m3 (sensible heat and latent heat).
  const HeatContent<PowerLawCurve> content{table1(), {0.0, 5.0}, true};
  EXPECT_NEAR(content.content(0.0, 0.375) - content.content(-10.0, 0.375), 136.7e6, 0.2e6);
}

TEST(HeatContent, SecantSumsToTheContent) {
  // The secant capacity times the temperature change equals the change of content to round-off, also across the melting
  // point.
  const HeatContent<PowerLawCurve> content{table1(), {0.0, 5.0}, true};
  for (const double change : {1e-3, 0.7, 5.0, -4.0}) {
    const double t = -1.3;
    EXPECT_NEAR(content.secant_capacity(t, change, 0.3) * change,
                content.content(t + change, 0.3) - content.content(t, 0.3), 1e-6);
  }
}

}  // namespace
}  // namespace thawslide::physics
