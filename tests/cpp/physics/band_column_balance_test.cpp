// Intake, losses and conservation of a band column, also as its height and its cells change.
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

double top_of(double thickness, double growth) { return ColumnGrid(thickness, growth, 0.01, 1.4).face(Cells::slide); }

TEST(ColumnHeight, IsTheDepthOfTheSlide) {
  EXPECT_NEAR(top_of(1.35, 1.4), 34.2, 0.1) << "below a slide 11 m thick";
  EXPECT_NEAR(top_of(1.35, cell_growth_below(11.0, 1.35, 1.4)), 11.0, 1e-12);
  for (const double thickness : {0.01, 0.21, 1.9}) {
    for (const double full : {1.4, 1.55}) {
      double last = 0.0;
      for (double growth = 1.0; growth <= full; growth += 0.003) {
        const double depth = top_of(thickness, growth), found = cell_growth_below(depth, thickness, full);
        EXPECT_NEAR(found, growth, 1e-13);
        EXPECT_GT(found, last);
        last = found;
      }
    }
  }
}

TEST(ColumnHeight, IsAtMostThatOfTheModelAndAtLeastTwoAndAHalfBands) {
  const double full = top_of(0.21, 1.4);
  for (const double depth : {full, std::nextafter(full, 10.0), 1e3, 1e300}) {
    EXPECT_EQ(cell_growth_below(depth, 0.21, 1.4), 1.4) << depth;
  }
  EXPECT_LT(cell_growth_below((1.0 - 1e-12) * full, 0.21, 1.4), 1.4);
  for (const double depth : {0.0, 0.1, 0.5, 2.5 * 0.21}) {
    EXPECT_EQ(cell_growth_below(depth, 0.21, 1.4), 1.0) << depth;
  }
  EXPECT_GT(cell_growth_below(2.5001 * 0.21, 0.21, 1.4), 1.0);
  EXPECT_NEAR(top_of(0.21, 1.0), 2.5 * 0.21, 1e-15);
  EXPECT_EQ(cell_growth_below(1e-3, 0.21, 1.0), 1.0);
}

// The ground cells do not follow those of the slide.
TEST(ColumnHeight, DoesNotChangeTheGround) {
  const Model model = make_model();
  const auto tall = grid_of(model, 0.3, 1.4), low = grid_of(model, 0.3, 1.05);
  for (int k = 0; k < Cells::ground + Cells::band; ++k) {
    EXPECT_EQ(tall.height(k), low.height(k));
  }
  EXPECT_GT(tall.face(Cells::slide), 2.0 * low.face(Cells::slide));
}

class RandomChanges : public testing::Test {
 protected:
  double between(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
  // Any possible change in a step: large stretching of either sign, a growing or constant band, any ratio of cells.
  ColumnChange change_of(const Column& column) {
    return {between(-0.6, 0.6), column.thickness, column.thickness * between(0.95, 1.05), column.cell_growth,
            between(0.0, 1.0) < 0.3 ? column.cell_growth : between(1.0, 1.4)};
  }
  // Applies the change to a column in its parts; returns the budget, per area at the end.
  static ColumnBudget apply(const Model& model, const ColumnChange& change, Column& column) {
    const int parts = parts_of(model, change);
    Drive drive = drive_of(model, 1.0, 0.0, -10.0);
    drive.stretching = std::expm1(change.stretch / parts);
    ColumnBudget sum;
    for (int part = 1; part <= parts; ++part) {
      ColumnBudget budget;
      drive.thickness = change.thickness_after(part, parts);
      drive.cell_growth = change.cell_growth_after(part, parts);
      mix_in_surroundings(model, grid_of(model, column), grid_of(model, drive.thickness, drive.cell_growth), drive,
                          column, budget);
      const double left = std::exp(-change.stretch / parts);
      sum.body_heat = left * sum.body_heat + budget.body_heat;
      sum.ground_heat = left * sum.ground_heat + budget.ground_heat;
      sum.body_water = left * sum.body_water + budget.body_water;
    }
    return sum;
  }
  std::mt19937 random_{7};
};

// Uniform fields remain uniform for any motion of the faces: the intake and losses of cells follow the swept volume.
TEST_F(RandomChanges, KeepUniformMaterialUniform) {
  const Model model = make_model();
  const double water = water_of_full_pores(model, -10.0), heat = body_enthalpy(model, -10.0);
  Column column = start_column(model, 0.3, 1.2, -10.0, -10.0, load);
  for (int step = 0; step < 500; ++step) {
    apply(model, change_of(column), column);
    const auto grid = grid_of(model, column);
    for (int k = 0; k < Cells::slide; ++k) {
      ASSERT_NEAR(column.water[k], water * grid.slide_height(k), 1e-11 * water * grid.slide_height(k)) << k;
      ASSERT_NEAR(column.heat[Cells::ground + k], heat * grid.slide_height(k),
                  1e-11 * std::abs(heat) * grid.slide_height(k))
          << k;
    }
  }
}

// Single wet cells among dry ones: no content becomes negative, and the sums equal the intake.
TEST_F(RandomChanges, KeepContentsNonNegative) {
  const Model model = make_model();
  int most_parts = 0, single = 0;
  for (int run = 0; run < 2000; ++run) {
    Column column = start_column(model, between(0.02, 2.0), between(1.0, 1.4), -10.0, -5.0, load);
    for (double& of_cell : column.water) {
      of_cell *= between(0.0, 1.0) < 0.7 ? 0.0 : 1.0;
    }
    for (int step = 0; step < 5; ++step) {
      const ColumnChange change = change_of(column);
      const double water = water_of(column), heat = heat_of(column), left = std::exp(-change.stretch);
      const ColumnBudget budget = apply(model, change, column);
      ASSERT_NEAR(water_of(column), left * water + budget.body_water, 1e-11 * (1.0 + water)) << run;
      ASSERT_NEAR(heat_of(column), left * heat + budget.body_heat + budget.ground_heat, 1e-11 * std::abs(heat)) << run;
      for (const double of_cell : column.water) {
        ASSERT_GE(of_cell, -1e-12 * (1.0 + water)) << run;
      }
      most_parts = std::max(most_parts, parts_of(model, change));
      single += std::abs(change.stretch) < 0.1 && parts_of(model, change) == 1 ? 1 : 0;
    }
  }
  EXPECT_GT(most_parts, 20);
  EXPECT_GT(single, 10);
}

// Columns of full height divide a step into parts of a tenth of stretching, for usual growth of the band.
TEST(ColumnHeight, DoesNotDivideTheStepsOfTallColumns) {
  const Model model = make_model();
  for (double stretch = -0.6; stretch < 0.6; stretch += 0.01) {
    for (const double grown : {0.98, 1.0, 1.02}) {
      const ColumnChange change{stretch, 0.3, 0.3 * grown, 1.4, 1.4};
      EXPECT_EQ(parts_of(model, change), std::max(1.0, std::ceil(std::abs(stretch) / 0.1))) << stretch << " " << grown;
    }
  }
}

// Two columns are brought to the same ratio before they merge; the budgets contain the resulting exchange with the
// body.
TEST(ColumnHeight, ChangesItsRatioByExchangeWithTheBody) {
  const Model model = make_model();
  const double heat = body_enthalpy(model, -10.0), water = water_of_full_pores(model, -10.0);
  for (const double growth : {1.0, 1.1, 1.25, 1.4}) {
    Column column = start_column(model, 0.5, 1.25, -10.0, -10.0, load);
    column.heat[Cells::ground] += 1e7;
    const Column before = column;
    const ColumnBudget budget = apply_cell_growth(model, growth, heat, water, column);
    EXPECT_EQ(column.cell_growth, growth);
    EXPECT_NEAR(heat_of(column), heat_of(before) + budget.body_heat, 1e-12 * std::abs(heat_of(before)));
    EXPECT_NEAR(water_of(column), water_of(before) + budget.body_water, 1e-12 * water_of(before));
    EXPECT_NEAR(budget.body_water, water * (top_of(0.5, growth) - top_of(0.5, 1.25)), 1e-9 * water);
    for (int k = 0; k < Cells::ground + Cells::band - 1; ++k) {
      EXPECT_NEAR(column.heat[k], before.heat[k], 1e-9 * std::abs(before.heat[k])) << "the band is unchanged";
    }
  }
}

}  // namespace
}  // namespace thawslide::physics
