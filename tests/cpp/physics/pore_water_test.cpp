#include "physics/pore_water.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/simd.hpp"
#include "physics/pressurization.hpp"
#include "table1.hpp"

namespace thawslide::physics {
namespace {

constexpr WaterExpansion constant{WaterExpansionLaw::constant, 2.75e-4};
constexpr WaterExpansion by_temperature{WaterExpansionLaw::by_temperature, 0.0};

TEST(WaterExpansion, IsLinearBetweenAndBeyondTheFourValues) {
  for (const auto& [temperature, expansion] : {std::pair(0.0, -0.7e-4),
                                               {20.0, 2.1e-4},
                                               {50.0, 4.6e-4},
                                               {100.0, 7.5e-4},
                                               {10.0, 0.7e-4},
                                               {35.0, 3.35e-4},
                                               {75.0, 6.05e-4},
                                               {-10.0, -2.1e-4},
                                               {200.0, 13.3e-4}}) {
    EXPECT_DOUBLE_EQ(by_temperature.at(temperature), expansion) << temperature;
    EXPECT_DOUBLE_EQ(by_temperature.at(Simd<double>(temperature))[0], expansion) << temperature;
    EXPECT_EQ(constant.at(temperature), 2.75e-4);
  }
}

// Trapezia by hand: 20 (-0.7 + 2.1)/2 + 30 (2.1 + 4.6)/2 + 50 (4.6 + 7.5)/2 = 14 + 100.5 + 302.5, times 1e-4. Water is
// densest where the expansion is 0, at 5 C on the first line: it is as dense at 10 C as at 0 C. Beyond: from 100 to 200
// C (7.5 + 13.3)/2 x 100, from -10 to 0 C (-2.1 - 0.7)/2 x 10.
TEST(WaterExpansion, IsIntegratedInClosedForm) {
  struct Row {
    double from, to, swelling;
  };
  for (const Row& row : {Row{0.0, 20.0, 14e-4}, Row{0.0, 100.0, 417e-4}, Row{100.0, 0.0, -417e-4}, Row{0.0, 10.0, 0.0},
                         Row{100.0, 200.0, 1040e-4}, Row{-10.0, 0.0, -14e-4}}) {
    const double allowed = std::abs(row.swelling) > 1e-2 ? 1e-16 : row.swelling == 0.0 ? 1e-18 : 1e-17;
    EXPECT_NEAR(by_temperature.swelling(row.from, row.to), row.swelling, allowed);
    EXPECT_NEAR(by_temperature.swelling(Simd<double>(row.from), Simd<double>(row.to))[0], row.swelling, allowed);
  }
  EXPECT_LT(by_temperature.swelling(0.0, 5.0), 0.0);
  EXPECT_DOUBLE_EQ(constant.swelling(4.0, 24.0), 5.5e-3);
}

TEST(WaterExpansion, SwellingIsAdditiveWithTheExpansionAsItsRate) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> temperature(-40.0, 220.0);
  for (int k = 0; k < 1000; ++k) {
    const double a = temperature(random), b = temperature(random), c = temperature(random);
    EXPECT_NEAR(by_temperature.swelling(a, b) + by_temperature.swelling(b, c), by_temperature.swelling(a, c), 2e-16);
    EXPECT_NEAR(by_temperature.swelling(a, b), -by_temperature.swelling(b, a), 1e-16);
    // The rate by a central difference, which is exact on a line; at a bend, the error is at most h times its jump.
    const double h = 1e-3;
    const double rate = (by_temperature.swelling(a - h, a + h)) / (2.0 * h);
    EXPECT_NEAR(rate, by_temperature.at(a), h * 1e-5);
  }
}

TEST(PoreWater, MixtureExpansionIsEquation8WithWatersOwn) {
  const auto phases = table1();
  for (const double saturation : {0.0, 0.3, 1.0}) {
    EXPECT_EQ(expansion(phases, 0.375, saturation, constant.at(3.0)), expansion(phases, 0.375, saturation));
  }
  // 0.625 x 3e-5 + 0.375 x 4.6e-4
  EXPECT_NEAR(expansion(phases, 0.375, 1.0, by_temperature.at(50.0)), 1.9125e-4, 1e-18);
  // 0.625 x 3e-5 x 100 + 0.375 x 417e-4
  EXPECT_NEAR(melted_swelling(phases, by_temperature, 0.375, 0.0, 100.0), 1.75125e-2, 1e-16);
  EXPECT_NEAR(melted_swelling(phases, constant, 0.375, 2.0, 12.0), 10.0 * expansion(phases, 0.375, 1.0), 1e-17);
}

TEST(PoreWater, StorageByHand) {
  const auto phases = table1();
  EXPECT_DOUBLE_EQ(pore_storage(phases, 0.375, 0.0), 3.75e-10);
  EXPECT_DOUBLE_EQ(pore_storage(phases, 0.375, 2e-9), 2.375e-9);
  EXPECT_EQ(storing_porosity(phases, 0.375, 0.0), 0.375);
  EXPECT_NEAR(storing_porosity(phases, 0.375, 2e-9) / phases.water_bulk_modulus, pore_storage(phases, 0.375, 2e-9),
              1e-24);
  // A rigid pore at constant volume: 325 kPa/K of heating, as undrained_pressure_coefficient has it.
  EXPECT_NEAR(melted_swelling(phases, constant, 0.375, 0.0, 1.0) / pore_storage(phases, 0.375, 0.0),
              undrained_pressure_coefficient(phases, 0.375, 1.0), 1e-7);
  // Water of a pore that melted: 0.375 x (1 - 0.917)
  EXPECT_NEAR(melting_void(phases, 0.375, 1.0), 0.031125, 1e-16);
  EXPECT_NEAR(melting_void(phases, 0.375, 0.4), 0.01245, 1e-16);
  // 255 K of constant expansion fill it.
  EXPECT_NEAR(melting_void(phases, 0.375, 1.0) / expansion(phases, 0.375, 1.0), 255.4, 0.05);
}

TEST(PoreWater, PressureIsBetweenZeroAndTheLoad) {
  EXPECT_EQ(bounded_pore_pressure(5e5, 8e5), 5e5);
  EXPECT_EQ(bounded_pore_pressure(9e5, 8e5), 8e5);
  EXPECT_EQ(bounded_pore_pressure(-1e5, 8e5), 0.0);
  EXPECT_EQ(bounded_pore_pressure(5e5, -1.0), 0.0);
}

// For any surplus, pressure, void and opening store it exactly, exclude each other, and respect the bounds.
TEST(PoreWater, SurplusIsStoredByPressureVoidAndOpening) {
  std::mt19937 random(13);
  std::uniform_real_distribution<double> surplus(-0.04, 0.04), load(-1e5, 1e6), exponent(-10.0, -7.0);
  int voids = 0, openings = 0, pressed = 0;
  for (int k = 0; k < 10000; ++k) {
    const double storage = std::pow(10.0, exponent(random)), normal = load(random);
    const double w = k % 2 == 0 ? surplus(random) : surplus(random) / 0.04 * storage * 1e6;
    const auto filling = pore_filling(w, storage, normal);
    EXPECT_NEAR(pore_surplus(filling, storage), w, 1e-17 + 1e-15 * std::abs(w));
    EXPECT_GE(filling.pressure, 0.0);
    EXPECT_LE(filling.pressure, std::max(0.0, normal));
    EXPECT_GE(filling.gas_void, 0.0);
    EXPECT_GE(filling.opening, 0.0);
    EXPECT_EQ(filling.gas_void * filling.pressure, 0.0);
    EXPECT_EQ(filling.gas_void * filling.opening, 0.0);
    if (filling.opening > 1e-12 * std::abs(w)) {
      EXPECT_EQ(filling.pressure, std::max(0.0, normal));
    }
    const auto unbounded = pore_filling(w, storage);
    EXPECT_EQ(unbounded.gas_void, filling.gas_void);
    EXPECT_EQ(unbounded.pressure, pore_filling(w, storage, HUGE_VAL).pressure);
    voids += filling.gas_void > 0.0 ? 1 : 0;
    openings += filling.opening > 0.0 ? 1 : 0;
    pressed += filling.pressure > 0.0 && filling.pressure < normal ? 1 : 0;
  }
  EXPECT_GT(voids, 1000);
  EXPECT_GT(openings, 1000);
  EXPECT_GT(pressed, 1000);
}

TEST(PoreWater, ThawingLeavesTheLoadMinusTheResidualStressAndTheVoid) {
  const auto phases = table1();
  const double storage = pore_storage(phases, 0.375, 1e-8), load = 8e5;
  // No void: N - s0.
  EXPECT_DOUBLE_EQ(pore_filling(thawing_surplus(storage, load, 2e5, 0.0), storage, load).pressure, 6e5);
  EXPECT_EQ(thawing_surplus(storage, load, load, 0.0), 0.0);
  EXPECT_EQ(thawing_surplus(storage, load, HUGE_VAL, 0.0), 0.0);
  // A void of 0.001: 6e5 - 0.001/1.0375e-8
  EXPECT_NEAR(pore_filling(thawing_surplus(storage, load, 2e5, 0.001), storage, load).pressure, 503614.457831, 1e-6);
  // The complete void of melt stores all of it, and most of the void remains.
  const double all = melting_void(phases, 0.375, 1.0);
  const auto filling = pore_filling(thawing_surplus(storage, load, 0.0, all), storage, load);
  EXPECT_EQ(filling.pressure, 0.0);
  EXPECT_NEAR(filling.gas_void, all - storage * load, 1e-17);
}

}  // namespace
}  // namespace thawslide::physics
