// A piece of base and its column below a slide of some depth.
#include "band/piece_step.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "../physics/band_column_model.hpp"

namespace thawslide::band {
namespace {

using Piece = BasePiece<2, double>;
using physics::ColumnAccount;

constexpr double weight = 2e4;  // of the slide [N/m3]

ColumnsModel<double> make_columns_model() {
  ColumnsModel<double> model;
  model.column = physics::make_model();
  model.body_temperature = model.ground_temperature = -10.0;
  model.load_time = 1.0;
  model.mixing_slip = 50.0;
  model.rock_density = 2750.0;
  model.largest_thickness = 40.0;
  return model;
}

const physics::Model& column_model(const ColumnsModel<double>& model) { return std::get<0>(model.column); }

Piece make_piece(const ColumnsModel<double>& model, double thickness, double depth, double area = 100.0) {
  Piece piece;
  piece.area = piece.area_of_column = area;
  follow_load(model, weight * depth, depth, 0.0, piece);
  start_column_of(model, thickness, piece);
  return piece;
}

double height_of(const ColumnsModel<double>& model, const Piece& piece) {
  return physics::grid_of(column_model(model), piece.column).face(physics::ColumnCells::slide);
}

double heat_of(const Piece& piece) { return piece.area_of_column * physics::heat_of(piece.column) + piece.heat; }
double water_of(const Piece& piece) { return piece.area_of_column * physics::water_of(piece.column); }

// The depth is the mean since the first load, and after ten times the time of the load that of the time before.
TEST(PieceStep, AveragesTheDepthOfTheSlide) {
  const ColumnsModel<double> model = make_columns_model();
  Piece piece;
  const double dt = 0.01;
  for (int step = 0; step < 400; ++step) {  // contact that switches on and off
    follow_load(model, step % 4 == 0 ? weight * 80.0 : 0.0, step % 4 == 0 ? 80.0 : 0.0, dt, piece);
  }
  EXPECT_NEAR(piece.depth, 20.0, 1e-9);
  for (int step = 0; step < 600; ++step) {
    follow_load(model, weight * 20.0, 20.0, dt, piece);
  }
  EXPECT_NEAR(piece.depth, 20.0, 1e-9);
  for (int step = 0; step < 1000; ++step) {
    follow_load(model, weight * 5.0, 5.0, dt, piece);
  }
  EXPECT_NEAR(piece.depth, 5.0 + 15.0 * std::exp(-1.0), 0.01);
  EXPECT_NEAR(piece.load, weight * 5.0, 1e-3 * weight);
}

// Below a slide deeper than a full column nothing is otherwise than with one ratio of cells for all columns.
TEST(PieceStep, IsBitForBitThatOfFullColumnsBelowADeepSlide) {
  ColumnsModel<double> model = make_columns_model();
  model.growth = BandGrowth::slip;
  model.growth_per_slip = 1e-3;
  std::mt19937 random(3);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  Piece piece = make_piece(model, 0.1, 40.0);
  Piece other = piece;
  for (int step = 0; step < 300; ++step) {
    const double stretch = between(-0.25, 0.28), before = other.column.thickness, flux = between(0.0, 5e6);
    for (Piece* each : {&piece, &other}) {
      each->area *= std::exp(stretch);
      each->heat += flux * each->area;
      each->speed = 20.0;
      each->slip += 20.0 * 0.05;
      each->depth = 40.0;
    }
    step_piece(model, 0.1, 0.05, piece);
    // The same written out, with the ratio of the model.
    const auto& column = column_model(model);
    const double log_area = std::log(other.area / other.area_of_column);
    const int parts = std::max(1, static_cast<int>(std::ceil(std::abs(log_area) / 0.1)));
    const double factor = std::exp(log_area / parts), heat = other.heat / parts, dt = 0.05 / parts;
    const double after = piece.column.thickness;
    for (int part = 1; part <= parts; ++part) {
      other.area_of_column = part == parts ? other.area : other.area_of_column * factor;
      physics::step_column(
          column,
          {dt, other.load, heat / (other.area_of_column * dt), (factor - 1.0) / dt,
           before + (after - before) * part / parts, column.growth, -physics::exponential_minus_one(-20.0 * dt / 50.0),
           physics::body_enthalpy(column, -10.0), physics::water_of_full_pores(column, -10.0)},
          other.column);
    }
    other.heat = 0.0;
    ASSERT_EQ(std::memcmp(&piece.column, &other.column, sizeof piece.column), 0) << step;
    ASSERT_EQ(piece.column.cell_growth, 1.4);
  }
  EXPECT_GT(piece.column.thickness, 0.3);
  EXPECT_GT(means_of(model, piece).temperature, 0.0);
}

// A slide that keeps its volume and spreads out to a fifth of its depth: the column gives back what it can no longer
// hold, so that it has no more ice and water than the slide above it. With one ratio for all it would have three times.
TEST(PieceStep, HoldsAtMostTheIceAndWaterOfASlideThatThins) {
  ColumnsModel<double> model = make_columns_model();
  model.growth = BandGrowth::slip;
  model.growth_per_slip = 5e-4;
  const double dt = 0.05, volume = 2000.0;
  const double of_body = physics::water_of_full_pores(column_model(model), -10.0);
  Piece piece = make_piece(model, 0.5, volume / 100.0);
  double heat = heat_of(piece), water = water_of(piece), friction = 0.0;
  bool gave_back = false;
  for (int step = 0; step < 2400; ++step) {
    piece.area *= step < 1200 ? std::exp(std::log(5.0) / 1200.0) : 1.0;
    piece.speed = step < 1200 ? 20.0 : 0.0;
    piece.slip += dt * piece.speed;
    piece.heat += step < 1200 ? dt * 2e4 * piece.area : 0.0;
    friction += step < 1200 ? dt * 2e4 * piece.area : 0.0;
    follow_load(model, weight * volume / piece.area, volume / piece.area, dt, piece);
    const ColumnAccount<double> account = step_piece(model, 0.5, dt, piece);
    heat += account.body_heat + account.ground_heat - account.vented_heat - account.steam_heat;
    water += account.body_water - account.vented_water - account.steam;
    gave_back = gave_back || account.body_water < 0.0;
    ASSERT_NEAR(height_of(model, piece), std::min(piece.depth, 25.367 * piece.column.thickness), 1e-3);
    ASSERT_LT(water_of(piece), 1.001 * of_body * volume) << "at any time";
    ASSERT_NEAR(heat_of(piece), heat + friction, 1e-11 * std::abs(heat));
    ASSERT_NEAR(water_of(piece), water, 1e-11 * water);
  }
  EXPECT_NEAR(piece.column.thickness, 0.5 + 5e-4 * 1200.0, 1e-9);
  EXPECT_GT(25.0 * piece.column.thickness * piece.area, 2.5 * volume) << "what a full column would hold";
  EXPECT_TRUE(gave_back) << "to the body, as the mean of the depth follows";
}

// Pieces that stretch, slow down, thin out, part and join at random: heat and water are what came in less what left, no
// cell holds less than nothing, and no column is taller than the slide or 2.5 bands.
TEST(PieceStep, LosesNothingInRandomLives) {
  std::mt19937 random(11);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  int joined = 0, shortened = 0;
  for (int run = 0; run < 30; ++run) {
    ColumnsModel<double> model = make_columns_model();
    model.growth = run % 2 == 0 ? BandGrowth::slip : BandGrowth::inertial;
    model.growth_per_slip = 1e-3;
    model.grain_size = 0.01;
    model.inertial_number = 0.3;
    Piece piece = make_piece(model, between(0.05, 1.0), between(0.0, 30.0));
    double heat = heat_of(piece), water = water_of(piece), scale = std::abs(heat);
    const auto book = [&](const ColumnAccount<double>& account) {
      heat += account.body_heat + account.ground_heat - account.vented_heat - account.steam_heat;
      water += account.body_water - account.vented_water - account.steam;
    };
    double depth = piece.depth;
    for (int step = 0; step < 200; ++step) {
      if (step % 20 == 19) {
        const Piece other = make_piece(model, between(0.05, 1.0), between(0.0, 30.0), piece.area * between(0.1, 2.0));
        heat += heat_of(other);
        water += water_of(other);
        joined += other.column.cell_growth != piece.column.cell_growth ? 1 : 0;
        book(take_over(model, other, piece));
      } else {
        depth *= between(0.8, 1.2);
        piece.area *= std::exp(between(-0.3, 0.3));
        piece.speed = between(0.0, 50.0);
        piece.slip += 0.05 * piece.speed;
        const double friction = piece.area * between(0.0, 1e5);
        piece.heat += friction;
        heat += friction;
        follow_load(model, weight * depth, depth, between(0.05, 2.0), piece);
        const double before = height_of(model, piece);
        book(step_piece(model, 0.05, 0.05, piece));
        ASSERT_LE(height_of(model, piece), (1.0 + 1e-9) * std::max(piece.depth, 2.5 * piece.column.thickness));
        shortened += height_of(model, piece) < 0.95 * before ? 1 : 0;
      }
      scale = std::max(scale, std::abs(heat));
      ASSERT_NEAR(heat_of(piece), heat, 1e-11 * scale) << run << ", step " << step;
      ASSERT_NEAR(water_of(piece), water, 1e-11 * std::max(water, 1.0)) << run << ", step " << step;
      for (const double of_cell : piece.column.water) {
        ASSERT_GE(of_cell, -1e-12 * physics::water_of(piece.column));
      }
    }
  }
  EXPECT_GT(joined, 100);
  EXPECT_GT(shortened, 20);
}

}  // namespace
}  // namespace thawslide::band
