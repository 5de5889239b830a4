#include "physics/mixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "physics/freezing.hpp"
#include "physics/pressurization.hpp"
#include "table1.hpp"

namespace thawslide::physics {
namespace {

TEST(Mixture, EffectiveSolidFractionOfTheTwoLimits) {
  const auto phases = table1();
  EXPECT_DOUBLE_EQ(effective_solid_fraction(phases, 0.375, 1.0), 0.625);
  EXPECT_NEAR(effective_solid_fraction(phases, 0.375, 0.0), 0.625 + 0.375 / 3.0, 1e-15);
}

TEST(Mixture, AveragesByHand) {
  const auto phases = table1();
  // 0.625 x 2750 + 0.375 (0.4 x 1000 + 0.6 x 917)
  EXPECT_NEAR(mixture_density(phases, 0.375, 0.4), 2075.075, 1e-9);
  // 0.625 x 2750 x 858 + 0.375 (0.4 x 1000 x 4180 + 0.6 x 917 x 2040)
  EXPECT_NEAR(heat_capacity(phases, 0.375, 0.4), 2522590.5, 1e-6);
  // 0.625 x 3 + 0.375 (0.4 x 0.58 + 0.6 x 2.22)
  EXPECT_NEAR(conductivity(phases, 0.375, 0.4), 2.4615, 1e-12);
  // thawed: 0.625 x 3e-5 + 0.375 x 2.75e-4
  EXPECT_NEAR(expansion(phases, 0.375, 1.0), 1.21875e-4, 1e-16);
  // frozen: 0.917 (0.625 x 3e-5 + 0.375 x 5.1e-5)
  EXPECT_NEAR(expansion(phases, 0.375, 0.0), 0.917 * (1.875e-5 + 1.9125e-5), 1e-16);
}

TEST(Mixture, MixesByVolume) {
  EXPECT_DOUBLE_EQ(mixed(10.0, -30.0, 0.25), -20.0);
  EXPECT_EQ(mixed(10.0, -30.0, 1.0), 10.0);
}

TEST(Mixture, PorosityConservesTheGrains) {
  // The grain fraction of a volume V is (1 - n) V; it may change only by thermal expansion.
  std::mt19937 random(7);
  std::uniform_real_distribution<double> strain(-0.05, 0.05), porosity(0.2, 0.6), change(-20.0, 20.0);
  const auto phases = table1();
  for (int k = 0; k < 1000; ++k) {
    const double n = porosity(random), e = strain(random), dt = change(random);
    const double updated = updated_porosity(phases, n, e, dt);
    EXPECT_NEAR((1.0 - updated) * std::exp(e), (1.0 - n) * std::exp(phases.rock_expansion * dt), 1e-14);
  }
  EXPECT_EQ(updated_porosity(phases, 0.5, 10.0, 0.0), largest_porosity);
  EXPECT_EQ(updated_porosity(phases, 0.5, -10.0, 0.0), smallest_porosity);
}

TEST(Mixture, PorosityRateIsEquation6) {
  const auto phases = table1();
  const double n = 0.375, h = 1e-6;
  EXPECT_NEAR((updated_porosity(phases, n, h, 0.0) - n) / h, 1.0 - n, 1e-5);
  EXPECT_NEAR((updated_porosity(phases, n, 0.0, 1.0) - n), -(1.0 - n) * 3e-5, 1e-9);
}

TEST(Clapeyron, IsContinuousAtMeltingAndFallsBelowIt) {
  const auto phases = table1();
  const double ice = ice_pressure(phases, 9.81, 50.0);
  EXPECT_NEAR(ice, 917.0 * 9.81 * 50.0, 1e-9);
  EXPECT_DOUBLE_EQ(liquid_pressure_clapeyron(phases, ice, 0.0, 0.0), ice / 0.917);
  // rho_L L_f ln(263.15/273.15) = -12.439 MPa at -10 C, by hand
  EXPECT_NEAR(liquid_pressure_clapeyron(phases, 0.0, -10.0, 0.0), -12.4387e6, 1e3);
  // Slope dP/dT = rho_L L_f/T: 1.22 MPa/K for water against ice.
  const double slope =
      (liquid_pressure_clapeyron(phases, ice, 0.0, 0.0) - liquid_pressure_clapeyron(phases, ice, -1e-4, 0.0)) / 1e-4;
  EXPECT_NEAR(slope, 1000.0 * 333.5e3 / 273.15, 10.0);
}

TEST(PorePressure, IsTheSaturationWeightedMean) {
  EXPECT_DOUBLE_EQ(pore_pressure(0.0, -1e9, 5e5), 5e5);
  EXPECT_DOUBLE_EQ(pore_pressure(1.0, 7e5, 5e5), 7e5);
  EXPECT_DOUBLE_EQ(pore_pressure(0.25, 4e5, 8e5), 7e5);
}

TEST(Pressurization, CoefficientsByHand) {
  const auto phases = table1();
  // 1e9 x 1.21875e-4/0.375
  EXPECT_NEAR(undrained_pressure_coefficient(phases, 0.375, 1.0), 325000.0, 1e-6);
  // 1e9 x 2e-8/(0.375 x 9810)
  EXPECT_NEAR(hydraulic_diffusivity(phases, 0.375, 1.0, 2e-8), 20.0 / (0.375 * 9810.0), 1e-15);
}

// Eq. 8 with Eqs. 3 and 6 conserves the mass of ice and water in a closed volume of rock, ice and water (Eq. 7): the
// loss in a step decreases with its square.
TEST(Pressurization, ConservesIceAndWaterOfAClosedVolume) {
  const auto phases = table1();
  const PowerLawCurve curve{0.0, 5.0};
  const double n = 0.375, r = phases.ice_density / phases.water_density;
  for (const double temperature : {-1.0, -0.2, 3.0}) {
    const auto start = curve.at(temperature);
    const auto lost = [&](double step) {
      const double warming = 2.0 * step, volume_strain = -1e-3 * step;
      const double melting = n * (1.0 - r) * start.derivative;
      const double pressure = (undrained_pressure_coefficient(phases, n, start.saturation) -
                               phases.water_bulk_modulus * melting / (n * start.saturation)) *
                                  warming -
                              pore_stiffness(phases, n, start.saturation) * volume_strain;
      const double water =
          phases.water_density * std::exp(pressure / phases.water_bulk_modulus - phases.water_expansion * warming);
      const double ice = phases.ice_density * std::exp(-phases.ice_expansion * warming);
      const double s = curve.saturation(temperature + warming);
      const double pore = updated_porosity(phases, n, volume_strain, warming) * std::exp(volume_strain);
      const double before =
          n * (start.saturation * phases.water_density + (1.0 - start.saturation) * phases.ice_density);
      return std::abs(pore * (s * water + (1.0 - s) * ice) - before) / before;
    };
    EXPECT_LT(lost(1e-3), 1e-4);
    EXPECT_NEAR(lost(1e-3) / lost(5e-4), 4.0, 0.05) << temperature;
  }
}

// The factor of subgrid diffusion is that of pure decay in a step: two half steps equal a whole one, and a zero step
// has no effect.
TEST(Seepage, WithinACellDecaysExponentially) {
  const double diffusivity = 5e-3, size = 0.05, dt = 0.01;
  const double whole = subgrid_diffusion_fraction(diffusivity, 1.0 / size, 2, dt);
  const double half = subgrid_diffusion_fraction(diffusivity, 1.0 / size, 2, 0.5 * dt);
  EXPECT_NEAR(1.0 - whole, (1.0 - half) * (1.0 - half), 1e-15);
  EXPECT_NEAR(whole, 1.0 - std::exp(-0.08), 1e-15);
  EXPECT_EQ(subgrid_diffusion_fraction(0.0, 1.0 / size, 2, dt), 0.0);
}

TEST(Mixture, LogarithmOfARatioKeepsAllDigits) {
  for (double ratio = 0.3; ratio < 3.0; ratio *= 1.003) {
    EXPECT_NEAR(log_of_ratio(273.15 * ratio, 273.15), std::log(ratio), 3e-16 * (1.0 + std::abs(std::log(ratio))))
        << ratio;
  }
  EXPECT_EQ(log_of_ratio(273.15, 273.15), 0.0);
  // The difference of close temperatures is not lost in their ratio.
  EXPECT_NEAR(log_of_ratio(273.15 + 1e-9, 273.15) / ((273.15 + 1e-9 - 273.15) / 273.15), 1.0, 1e-11);
}

}  // namespace
}  // namespace thawslide::physics
