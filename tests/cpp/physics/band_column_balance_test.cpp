// Intake, losses and conservation of a band column.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "band_column_model.hpp"

namespace thawslide::physics {
namespace {

// A hot band in cold material, stretched to `area` times its area while it grows to `grown` times its thickness, mixes
// with the material above. The fraction of its hot material is then 1/(area grown).
TEST(BandColumn, MixesEnthalpyWhileItStretchesAndGrows) {
  Model model = make_model();
  model.conduction = model.pressurization = model.steam = false;
  const double e = 0.1;
  Column column = start_column(model, e, model.growth, -10.0, -10.0, load);
  const double cold = body_enthalpy(model, -10.0), hot = cold + 3e7;
  for (int k = 0; k < Cells::band; ++k) {
    column.heat[Cells::ground + k] = hot * e / Cells::band;
  }
  Drive drive = drive_of(model, 0.01, e, -10.0);
  double area = 1.0;
  for (int step = 0; step < 200; ++step) {
    drive.stretching = 0.3;
    drive.thickness = e * (1.0 + 0.5 * (step + 1) / 200.0);
    step_column(model, drive, column);
    area *= 1.0 + drive.stretching * drive.dt;
  }
  double band = 0.0;
  for (int k = 0; k < Cells::band; ++k) {
    band += column.heat[Cells::ground + k];
  }
  const double fraction = 1.0 / (area * 1.5);
  EXPECT_NEAR(band / (1.5 * e), fraction * hot + (1.0 - fraction) * cold, 1e-10 * hot);
}

// A completely mixed band has uniform temperature and liquid saturation; nothing is lost, and its surroundings are
// unchanged.
TEST(BandColumn, ShearMixesTheBand) {
  Model model = make_model();
  model.conduction = model.seepage = false;
  Column column = start_column(model, 0.2, model.growth, 5.0, 5.0, load);
  column.heat[Cells::ground + 2] += 1e6;
  column.water[1] *= 0.5;
  const double heat = heat_of(column), water = water_of(column), above = column.heat[Cells::ground + Cells::band];
  Drive drive = drive_of(model, 0.01, 0.2, 5.0);
  drive.mixed = 1.0;
  step_column(model, drive, column);
  EXPECT_NEAR(heat_of(column), heat, 1e-12 * heat);
  EXPECT_NEAR(water_of(column), water, 1e-12 * water);
  EXPECT_EQ(column.heat[Cells::ground + Cells::band], above);
  for (int k = 1; k < Cells::band; ++k) {
    EXPECT_NEAR(column.temperature[Cells::ground + k], column.temperature[Cells::ground], 1e-9);
    EXPECT_NEAR(column.water[k], column.water[0], 1e-12 * column.water[0]);
  }
}

// Two columns of different thickness and heat merge into one with the content of both.
TEST(BandColumn, TwoMergeIntoOneWithTheContentOfBoth) {
  const Model model = make_model();
  Column hot = start_column(model, 0.3, model.growth, 60.0, 5.0, load),
         cold = start_column(model, 0.1, model.growth, -10.0, -10.0, load);
  Drive drive = drive_of(model, 0.01, 0.3, 60.0);
  drive.heat_flux = 1e6;
  for (int step = 0; step < 20; ++step) {
    step_column(model, drive, hot);
  }
  for (const double fraction : {0.0, 0.2, 0.7, 1.0}) {
    const Column joined = joined_columns(model, fraction, hot, cold, load);
    EXPECT_NEAR(joined.thickness, fraction * 0.3 + (1.0 - fraction) * 0.1, 1e-15);
    EXPECT_NEAR(heat_of(joined), fraction * heat_of(hot) + (1.0 - fraction) * heat_of(cold), 1e-6);
    EXPECT_NEAR(water_of(joined), fraction * water_of(hot) + (1.0 - fraction) * water_of(cold), 1e-12 * water_of(hot));
    for (int k = 0; k < Cells::slide; ++k) {
      EXPECT_GE(joined.pressure[k], 0.0);
      EXPECT_LE(joined.pressure[k], load);
    }
  }
  // Pressures agree except for the difference that a step leaves between its seepage and its swelling.
  const Column same = joined_columns(model, 0.4, hot, hot, load);
  for (int k = 0; k < Cells::slide; ++k) {
    EXPECT_NEAR(same.temperature[Cells::ground + k], hot.temperature[Cells::ground + k], 1e-9);
    EXPECT_NEAR(same.pressure[k], hot.pressure[k], 1e-5 * load);
  }
}

// After any sequence of changes, heat and water equal intake minus losses, and 0 <= P <= N.
TEST(BandColumn, ConservesHeatAndWaterInRandomSteps) {
  std::mt19937 random(5);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  double hottest = 0.0, opening = 0.0, vented = 0.0, steam = 0.0;
  for (int run = 0; run < 20; ++run) {
    Model model = make_model();
    model.hydraulic_conductivity = std::pow(10.0, between(-8.0, -5.0));
    model.skeleton_compressibility = std::pow(10.0, between(-9.0, -7.0));
    model.residual_stress = between(0.0, 2.0 * load);
    model.at_frozen = run % 2 == 0 ? EndOfWater::sealed : EndOfWater::vented;
    model.water_expansion.law = run % 3 == 0 ? WaterExpansionLaw::constant : WaterExpansionLaw::by_temperature;
    model.water_to_steam_viscosity = run % 2 == 0 ? 0.0 : 50.0;
    double e = between(0.02, 0.6);
    const double body = run % 4 == 3 ? 5.0 : -10.0;
    Column column = start_column(model, e, model.growth, body, -5.0, load);
    double heat = heat_of(column), water = water_of(column), scale = 0.0;
    for (int step = 0; step < 400; ++step) {
      Drive drive = drive_of(model, between(0.001, 0.1), e, body);
      drive.normal_pressure = step % 50 == 0 ? 0.0 : load * between(0.5, 1.5);
      drive.heat_flux = between(0.0, 2e7);
      drive.stretching = between(-0.1, 0.12);
      drive.mixed = run % 2 == 0 ? 0.0 : between(0.0, 1.0);
      e = drive.thickness = e * between(0.98, 1.02);
      const double left = 1.0 / (1.0 + drive.stretching * drive.dt);
      const ColumnBudget budget = step_column(model, drive, column);
      heat = left * heat + budget.friction_heat + budget.body_heat + budget.ground_heat - budget.vented_heat -
             budget.steam_heat;
      water = left * water + budget.body_water - budget.vented_water - budget.steam;
      scale = std::max(scale, std::abs(heat));
      ASSERT_NEAR(heat_of(column), heat, 1e-11 * scale) << run << ", step " << step;
      ASSERT_NEAR(water_of(column), water, 1e-11 * water) << run << ", step " << step;
      for (int k = 0; k < Cells::slide; ++k) {
        ASSERT_GE(column.pressure[k], 0.0);
        ASSERT_LE(column.pressure[k], drive.normal_pressure);
        ASSERT_GE(column.water[k], -1e-12 * water);
        hottest = std::max(hottest, column.temperature[Cells::ground + k]);
      }
      opening = std::max(opening, column_volumes(model, drive.normal_pressure, column).opening);
      vented += budget.vented_water;
      steam += budget.steam;
    }
  }
  EXPECT_GT(hottest, 200.0);
  EXPECT_GT(opening, 0.0);
  EXPECT_GT(vented, 0.0);
  EXPECT_GT(steam, 0.0);
}

}  // namespace
}  // namespace thawslide::physics
