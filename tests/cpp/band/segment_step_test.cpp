// A basal segment and its column below a slide of some depth.
#include "band/segment_step.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "../physics/band_column_model.hpp"

namespace thawslide::band {
namespace {

using Segment = BasalSegment<2>;
using physics::ColumnBudget;

constexpr double weight = 2e4;  // of the slide [N/m3]

ColumnsModel make_columns_model() {
  ColumnsModel model;
  model.column = physics::make_model();
  model.body_temperature = model.ground_temperature = -10.0;
  model.load_time = 1.0;
  model.mixing_slip = 50.0;
  model.rock_density = 2750.0;
  model.largest_thickness = 40.0;
  return model;
}

const physics::Model& column_model(const ColumnsModel& model) { return model.column.power_law; }

Segment make_segment(const ColumnsModel& model, double thickness, double depth, double area = 100.0) {
  Segment segment;
  segment.area = segment.area_of_column = area;
  follow_load(model, weight * depth, depth, 0.0, segment);
  start_column_of(model, thickness, segment);
  return segment;
}

double height_of(const ColumnsModel& model, const Segment& segment) {
  return physics::grid_of(column_model(model), segment.column).face(physics::ColumnCells::slide);
}

double heat_of(const Segment& segment) {
  return segment.area_of_column * physics::heat_of(segment.column) + segment.heat;
}
double water_of(const Segment& segment) { return segment.area_of_column * physics::water_of(segment.column); }

// The depth is the mean since the first load; after ten times the load time, it is that of the load time before.
TEST(SegmentStep, AveragesTheDepthOfTheSlide) {
  const ColumnsModel model = make_columns_model();
  Segment segment;
  const double dt = 0.01;
  for (int step = 0; step < 400; ++step) {  // contact that alternates
    follow_load(model, step % 4 == 0 ? weight * 80.0 : 0.0, step % 4 == 0 ? 80.0 : 0.0, dt, segment);
  }
  EXPECT_NEAR(segment.depth, 20.0, 1e-9);
  for (int step = 0; step < 600; ++step) {
    follow_load(model, weight * 20.0, 20.0, dt, segment);
  }
  EXPECT_NEAR(segment.depth, 20.0, 1e-9);
  for (int step = 0; step < 1000; ++step) {
    follow_load(model, weight * 5.0, 5.0, dt, segment);
  }
  EXPECT_NEAR(segment.depth, 5.0 + 15.0 * std::exp(-1.0), 0.01);
  EXPECT_NEAR(segment.load, weight * 5.0, 1e-3 * weight);
}

// A slide of constant volume spreads to a fifth of its depth. The column returns excess ice and water to the body, and
// therefore never contains more than the slide above it. With one ratio for all columns it would contain three times as
// much.
TEST(SegmentStep, ContainsAtMostTheIceAndWaterOfAThinningSlide) {
  ColumnsModel model = make_columns_model();
  model.growth = BandGrowth::slip;
  model.growth_per_slip = 5e-4;
  const double dt = 0.05, volume = 2000.0;
  const double of_body = physics::water_of_full_pores(column_model(model), -10.0);
  Segment segment = make_segment(model, 0.5, volume / 100.0);
  double heat = heat_of(segment), water = water_of(segment), friction = 0.0;
  bool returned_water = false;
  for (int step = 0; step < 2400; ++step) {
    segment.area *= step < 1200 ? std::exp(std::log(5.0) / 1200.0) : 1.0;
    segment.speed = step < 1200 ? 20.0 : 0.0;
    segment.slip += dt * segment.speed;
    segment.heat += step < 1200 ? dt * 2e4 * segment.area : 0.0;
    friction += step < 1200 ? dt * 2e4 * segment.area : 0.0;
    follow_load(model, weight * volume / segment.area, volume / segment.area, dt, segment);
    const ColumnBudget budget = step_segment(model, 0.5, dt, segment);
    heat += budget.body_heat + budget.ground_heat - budget.vented_heat - budget.steam_heat;
    water += budget.body_water - budget.vented_water - budget.steam;
    returned_water = returned_water || budget.body_water < 0.0;
    ASSERT_NEAR(height_of(model, segment), std::min(segment.depth, 25.367 * segment.column.thickness), 1e-3);
    ASSERT_LT(water_of(segment), 1.001 * of_body * volume) << "at any time";
    ASSERT_NEAR(heat_of(segment), heat + friction, 1e-11 * std::abs(heat));
    ASSERT_NEAR(water_of(segment), water, 1e-11 * water);
  }
  EXPECT_NEAR(segment.column.thickness, 0.5 + 5e-4 * 1200.0, 1e-9);
  EXPECT_GT(25.0 * segment.column.thickness * segment.area, 2.5 * volume) << "content of a full column";
  EXPECT_TRUE(returned_water) << "to the body, as the mean of the depth follows";
}

// Segments that stretch, slow down, thin out, split and merge at random: heat and water equal intake minus losses, no
// cell has a negative content, and no column is taller than the slide or 2.5 bands.
TEST(SegmentStep, ConservesHeatAndWaterInRandomHistories) {
  std::mt19937 random(11);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  int joined = 0, shortened = 0;
  for (int run = 0; run < 30; ++run) {
    ColumnsModel model = make_columns_model();
    model.growth = run % 2 == 0 ? BandGrowth::slip : BandGrowth::inertial;
    model.growth_per_slip = 1e-3;
    model.grain_size = 0.01;
    model.inertial_number = 0.3;
    Segment segment = make_segment(model, between(0.05, 1.0), between(0.0, 30.0));
    double heat = heat_of(segment), water = water_of(segment), scale = std::abs(heat);
    const auto book = [&](const ColumnBudget& budget) {
      heat += budget.body_heat + budget.ground_heat - budget.vented_heat - budget.steam_heat;
      water += budget.body_water - budget.vented_water - budget.steam;
    };
    double depth = segment.depth;
    for (int step = 0; step < 200; ++step) {
      if (step % 20 == 19) {
        const Segment other =
            make_segment(model, between(0.05, 1.0), between(0.0, 30.0), segment.area * between(0.1, 2.0));
        heat += heat_of(other);
        water += water_of(other);
        joined += other.column.cell_growth != segment.column.cell_growth ? 1 : 0;
        book(merge_from(model, other, segment));
      } else {
        depth *= between(0.8, 1.2);
        segment.area *= std::exp(between(-0.3, 0.3));
        segment.speed = between(0.0, 50.0);
        segment.slip += 0.05 * segment.speed;
        const double friction = segment.area * between(0.0, 1e5);
        segment.heat += friction;
        heat += friction;
        follow_load(model, weight * depth, depth, between(0.05, 2.0), segment);
        const double before = height_of(model, segment);
        book(step_segment(model, 0.05, 0.05, segment));
        ASSERT_LE(height_of(model, segment), (1.0 + 1e-9) * std::max(segment.depth, 2.5 * segment.column.thickness));
        shortened += height_of(model, segment) < 0.95 * before ? 1 : 0;
      }
      scale = std::max(scale, std::abs(heat));
      ASSERT_NEAR(heat_of(segment), heat, 1e-11 * scale) << run << ", step " << step;
      ASSERT_NEAR(water_of(segment), water, 1e-11 * std::max(water, 1.0)) << run << ", step " << step;
      for (const double of_cell : segment.column.water) {
        ASSERT_GE(of_cell, -1e-12 * physics::water_of(segment.column));
      }
    }
  }
  EXPECT_GT(joined, 100);
  EXPECT_GT(shortened, 20);
}

}  // namespace
}  // namespace thawslide::band
