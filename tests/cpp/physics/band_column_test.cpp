#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "../exact/heat.hpp"
#include "../exact/water.hpp"
#include "band_column_model.hpp"

namespace thawslide::physics {
namespace {

class Undrained : public testing::TestWithParam<WaterExpansionLaw> {};

// Adiabatic and undrained: T = T0 + q t/(C e), P = P0 + integral of beta_m dT/S_s, until P = N; further expansion opens
// the base.
TEST_P(Undrained, HeatingIsTheClosedForm) {
  Model model = make_model();
  model.water_expansion.law = GetParam();
  model.conduction = model.seepage = model.steam = false;
  model.residual_stress = load - 1e4;
  const double e = 0.1, flux = 1e5, dt = 0.01;
  Column column = start_column(model, e, model.growth, 20.0, 20.0, load);
  EXPECT_DOUBLE_EQ(column.pressure[0], 1e4) << "N - s0";
  Drive drive = drive_of(model, dt, e, 20.0);
  drive.heat_flux = flux;
  double time = 0.0;
  const auto advance_to = [&](double end) {
    for (; time < end - 0.5 * dt; time += dt) {
      step_column(model, drive, column);
    }
  };
  advance_to(1.0);
  const double one_second = 20.0 + flux / (melted_capacity(model) * e);
  EXPECT_NEAR(column.temperature[Cells::ground + 3], one_second, 1e-10);
  EXPECT_NEAR(column.pressure[3], 1e4 + swelling(model, 20.0, one_second) / storage(model), 1e-7 * load);
  advance_to(60.0);
  const double end = 20.0 + 60.0 * flux / (melted_capacity(model) * e);
  EXPECT_DOUBLE_EQ(column.pressure[3], load);
  EXPECT_NEAR(column_volumes(model, load, column).opening,
              e * (swelling(model, 20.0, end) - storage(model) * (load - 1e4)), 1e-9 * e);
}
INSTANTIATE_TEST_SUITE_P(BandColumn, Undrained,
                         testing::Values(WaterExpansionLaw::constant, WaterExpansionLaw::by_temperature));

// dP = m_v dN/S_s immediately, and reversible.
TEST(BandColumn, PressureFollowsAnUnloading) {
  Model model = make_model();
  model.conduction = model.seepage = false;
  model.residual_stress = 2e5;
  Column column = start_column(model, 0.1, model.growth, 5.0, 5.0, load);
  Drive drive = drive_of(model, 0.01, 0.1, 5.0);
  drive.normal_pressure = 4e5;
  step_column(model, drive, column);
  EXPECT_NEAR(column.pressure[0], 3e5 - 1e5 * model.skeleton_compressibility / storage(model), 1e-3);
  drive.normal_pressure = load;
  step_column(model, drive, column);
  EXPECT_NEAR(column.pressure[0], 3e5, 1e-3);
  // Between two steps of the column, the basal law uses a pressure not above the load.
  EXPECT_NEAR(band_means(model, load, column).pore_pressure, 3e5, 1e-3);
  EXPECT_NEAR(band_means(model, 1e5, column).pore_pressure, 1e5, 1e-3);
}

// Melt fills a fraction r of the pore that its ice filled: the void n (1 - r) accommodates the first expansion.
TEST(BandColumn, MeltLeavesAVoidThatHeatingFillsFirst) {
  Model model = make_model();
  model.conduction = model.seepage = model.steam = false;
  model.residual_stress = 0.0;
  const double e = 0.1, dt = 0.05;
  Column column = start_column(model, e, model.growth, -10.0, -10.0, 1e4);
  Drive drive = drive_of(model, dt, e, -10.0);
  drive.normal_pressure = 1e4;
  drive.heat_flux = 1e6;
  while (!is_melted(model, column, 0)) {
    step_column(model, drive, column);
    EXPECT_LE(column.pressure[0], 1e4);
  }
  const double ratio = model.phases.ice_density / model.phases.water_density;
  const double saturation = model.curve.saturation(-10.0);
  const double gas_void = model.porosity * (1.0 - ratio) * (1.0 - saturation);
  const double on_thawing = storage(model) * 1e4;  // s0 = 0: P would start at N
  while (column.pressure[0] == 0.0) {
    step_column(model, drive, column);
  }
  const double temperature = column.temperature[Cells::ground];
  const double swells_by = (1.0 - model.porosity) * model.phases.rock_expansion +
                           model.porosity * ratio * model.phases.water_expansion;  // of the melt, per kelvin
  const double filled_at = (gas_void - on_thawing) / swells_by;
  EXPECT_GT(filled_at, 200.0);
  EXPECT_NEAR(temperature, filled_at, 0.01 * filled_at + 1e6 * dt / (e * melted_capacity(model)));
}

// A band that drains into air above it, sealed below, heated by friction with a strength mu (N - P), in balance:
//   tau = mu N/(1 + mu beta_m gamma_w eta v e/(3 C k)),   with P the mean over the band.
TEST(BandColumn, DrainedBandReachesItsSteadyStrength) {
  Model model = make_model();
  model.conduction = false;
  model.at_frozen = EndOfWater::vented;
  model.hydraulic_conductivity = 1e-8;
  const double e = 0.1, friction = 0.3, speed = 2.0, dt = 0.02;
  Column column = start_column(model, e, model.growth, -10.0, -10.0, load);
  const ColumnGrid grid = grid_of(model, e, model.growth);
  for (int k = 0; k < Cells::band; ++k) {  // only the band is melted, and its pores are full
    column.water[k] = model.porosity * model.phases.water_density * grid.slide_height(k);
    column.heat[Cells::ground + k] =
        enthalpy(model.curve, cell_coefficients(model, grid, column, Cells::ground + k), 1.0);
    column.temperature[Cells::ground + k] = 1.0;
  }
  Drive drive = drive_of(model, dt, e, -10.0);
  double strength = 0.0;
  for (int step = 0; step < 4000; ++step) {
    strength = friction * (load - band_means(model, load, column).pore_pressure);
    drive.heat_flux = strength * speed;
    step_column(model, drive, column);
  }
  const double expansion = swelling(model, 10.0, 11.0);
  const double divisor = friction * expansion * model.phases.water_unit_weight * speed * e /
                         (3.0 * melted_capacity(model) * model.hydraulic_conductivity);
  EXPECT_GT(divisor, 0.3);
  EXPECT_NEAR(strength, friction * load / (1.0 + divisor), 0.01 * friction * load);
}

// Slip on a plane (Rice 2006), with material on one side: the plane is a band thinner than the diffusion lengths of
// heat and water.
TEST(BandColumn, StrengthOfASlippingPlane) {
  Model model = make_model();
  model.growth = 1.55;
  model.ground_conductivity = 1e-12;
  model.skeleton_compressibility = 0.0;
  model.steam = false;
  const double capacity = melted_capacity(model);
  const double thermal = conductivity(model.phases, model.porosity, 1.0) / capacity, hydraulic = 4.0 * thermal;
  model.hydraulic_conductivity = hydraulic * model.phases.water_unit_weight * storage(model);
  const double coefficient = swelling(model, 0.0, 1.0) / storage(model);
  const double friction = 0.25, speed = 1.0;
  const double length = exact::one_sided_slip_length(capacity, coefficient, hydraulic, thermal, friction, speed);
  const double reach = std::sqrt(thermal * length / speed);
  const double e = 0.05 * reach, dt = 2e-4 * length / speed;
  Column column = start_column(model, e, model.growth, 10.0, 10.0, load);
  Drive drive = drive_of(model, dt, e, 10.0);
  double slip = 0.0, largest = 0.0;
  while (slip < length) {
    drive.heat_flux = friction * (load - column.pressure[0]) * speed;
    step_column(model, drive, column);
    slip += speed * dt;
    if (slip > 0.05 * length) {
      largest = std::max(largest, std::abs(drive.heat_flux / (friction * load * speed) -
                                           exact::strength_on_plane(slip - 0.5 * speed * dt, length)));
    }
  }
  EXPECT_LT(largest, 0.02);
}

// A column that freezes from ground at constant -10 C (Neumann).
TEST(BandColumn, FreezingFrontIsNeumanns) {
  ModelOf<LinearCurve> model;
  const Model numbers = make_model();
  model.phases = numbers.phases;
  model.phases.water_density = model.phases.ice_density;
  model.curve = {0.0, 50.0};  // over 0.02 K
  model.water_expansion = numbers.water_expansion;
  model.porosity = numbers.porosity;
  model.pressurization = false;
  model.growth = 1.0;
  model.ground_conductivity = 1e6;
  model.ground_capacity = 1e12;
  model.ground_cell = 1.0;
  const double e = 0.16;
  Column column = start_column(model, e, model.growth, 5.0, -10.0, load);
  const double water = model.porosity * model.phases.ice_density;
  const auto of = slide_coefficients(model, 1.0, water);
  const double frozen_k = conductivity(model.phases, model.porosity, 0.0);
  const double melted_k = conductivity(model.phases, model.porosity, 1.0);
  const exact::SharpFront front(
      {5.0, -10.0, 0.0, 0.0, {frozen_k, frozen_k, melted_k}, {of.frozen, of.frozen, of.frozen + of.rise}, of.melting});
  const Drive drive = drive_of(model, 20.0, e, 5.0);
  const ColumnGrid grid = grid_of(model, e, model.growth);
  double time = 0.0;
  for (; time < 40000.0; time += drive.dt) {
    step_column(model, drive, column);
  }
  const double depth = 2.0 * front.psi() * std::sqrt(frozen_k / of.frozen * time);
  EXPECT_GT(depth, 5 * grid.slide_height(0));
  EXPECT_LT(depth, 0.6 * grid.face(Cells::slide));
  double frozen = 0.0, largest = 0.0;
  for (int k = 0; k < Cells::slide; ++k) {
    const double height = 0.5 * (grid.face(k) + grid.face(k + 1)), found = column.temperature[Cells::ground + k];
    frozen += grid.slide_height(k) * (1.0 - model.curve.saturation(found));
    largest = std::max(largest, std::abs(found - front.temperature(height, time)));
  }
  EXPECT_NEAR(frozen, depth, 0.02 * depth);
  EXPECT_LT(largest, 0.05 * 15.0) << "within half a cell of the front";
}

class Boiling : public testing::TestWithParam<double> {};

// Water boils when its steam pressure carries the load, and is gone after n r rho_L L_v e/q.
TEST_P(Boiling, TakesTheTimeOfItsLatentHeat) {
  Model model = make_model();
  model.conduction = model.seepage = false;
  const double e = 0.1, flux = 2e6, dt = 0.02, boiling = boiling_temperature(GetParam());
  Column column = start_column(model, e, model.growth, -10.0, -10.0, GetParam());
  Drive drive = drive_of(model, dt, e, -10.0);
  drive.normal_pressure = GetParam();
  drive.heat_flux = flux;
  double time = 0.0, begun = 0.0;
  const double all = column.water[0];
  while (column.water[0] > 0.0) {
    step_column(model, drive, column);
    time += dt;
    if (column.water[0] == all) {
      begun = time;
    } else if (column.water[0] > 0.0) {
      EXPECT_NEAR(column.temperature[Cells::ground], boiling, 1e-7);
      EXPECT_NEAR(column.pressure[0], GetParam(), 1e-7 * load);
    }
  }
  const double exact = water_of_full_pores(model, -10.0) * heat_of_vaporization(boiling) * e / flux;
  EXPECT_NEAR(time - begun, exact, 2.0 * dt);
  step_column(model, drive, column);
  EXPECT_GT(column.temperature[Cells::ground], boiling + 0.1) << "dry material continues to heat";
}
INSTANTIATE_TEST_SUITE_P(BandColumn, Boiling, testing::Values(0.0, 2e5));

// Steam exerts pressure in a void: P is the vapour pressure at T, long before water fills the pores again.
TEST(BandColumn, SteamExertsPressureInAVoid) {
  Model model = make_model();
  model.conduction = false;
  Column column = start_column(model, 0.1, model.growth, -10.0, -10.0, load);
  Drive drive = drive_of(model, 0.02, 0.1, -10.0);
  drive.heat_flux = 1e6;
  while (column.temperature[Cells::ground] < 130.0) {
    step_column(model, drive, column);
  }
  EXPECT_NEAR(boiling_temperature(column.pressure[0]), column.temperature[Cells::ground], 1e-7);
  EXPECT_GT(column_volumes(model, load, column).gas_void, 0.0);
}

// Thaw consolidation (Morgenstern and Nixon 1971): r = 1, s0 = 0, no heating; material thaws from a drained top down to
// X = a sqrt(t): u/N = erf(z/(2 sqrt(c t)))/(erf R + exp(-R^2)/(sqrt(pi) R)), R = a/(2 sqrt(c)).
TEST(BandColumn, ThawConsolidation) {
  Model model = make_model();
  model.phases.ice_density = model.phases.water_density;
  model.phases.water_expansion = model.water_expansion.constant = model.phases.rock_expansion = 0.0;
  model.latent = model.conduction = false;
  model.residual_stress = 0.0;
  model.growth = 1.0;
  const double e = 0.8;
  const ColumnGrid grid = grid_of(model, e, model.growth);
  const double consolidation = model.hydraulic_conductivity / (model.phases.water_unit_weight * storage(model));
  const double height = grid.face(Cells::slide), ratio = 0.6, speed = ratio * 2.0 * std::sqrt(consolidation);
  Column column = start_column(model, e, model.growth, -1.0, -1.0, load);
  const double end = std::pow(0.95 * height / speed, 2.0), dt = end / 4000.0;
  const Drive drive = drive_of(model, dt, e, -1.0);
  for (int step = 0; step < 4000; ++step) {
    const double front = speed * std::sqrt((step + 0.5) * dt);
    for (int k = 0; k < Cells::slide; ++k) {
      const double middle = height - 0.5 * (grid.face(k) + grid.face(k + 1));
      if (middle < front && column.temperature[Cells::ground + k] < 0.0) {
        column.temperature[Cells::ground + k] = 1e-6;
        column.heat[Cells::ground + k] =
            enthalpy(model.curve, cell_coefficients(model, grid, column, Cells::ground + k), 1e-6);
      }
    }
    step_column(model, drive, column);
  }
  const double pi = std::acos(-1.0);
  const double divisor = std::erf(ratio) + std::exp(-ratio * ratio) / (std::sqrt(pi) * ratio);
  double mean = 0.0, exact_mean = 0.0;
  for (int k = 1; k < Cells::slide; ++k) {
    const double depth = height - 0.5 * (grid.face(k) + grid.face(k + 1));
    const double exact = std::erf(depth / (2.0 * std::sqrt(consolidation * end))) / divisor;
    mean += column.pressure[k] / load;
    exact_mean += exact;
    if (k > 2) {  // cells thaw completely: the front is at the last cell that thawed
      EXPECT_NEAR(column.pressure[k] / load, exact, 0.045) << k;
    }
  }
  EXPECT_NEAR(mean, exact_mean, 0.03 * exact_mean);
}

}  // namespace
}  // namespace thawslide::physics
