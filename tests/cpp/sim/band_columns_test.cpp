// Band columns below a slide: balances, motion, reproducibility, and agreement with those of the rigid block.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "../physics/band_column_model.hpp"
#include "../support/case_from_text.hpp"
#include "../support/column_slab.hpp"
#include "../support/reproducible_runs.hpp"
#include "band/basal_segments.hpp"
#include "base/error.hpp"
#include "sim/block/block.hpp"
#include "sim/block/block_column.hpp"
#include "sim/records/end_state.hpp"
#include "sim/records/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

template <int Dim>
void expect_balances() {
  Simulation<Dim> simulation(case_from_text(column_slab(Dim)));
  while (simulation.time() < 3.0 - 1e-9) {
    simulation.step(simulation.next_step(3.0));
    for (const auto& segment : simulation.band_columns()->segments()) {
      EXPECT_LE(band::current_means(segment).pore_pressure, segment.load) << "at every step";
    }
    const HistoryRow row = history_row(simulation);
    const double heat = value_of(row, "friction_heat_J");
    EXPECT_GT(heat, 0.0);
    EXPECT_LT(std::abs(value_of(row, "thermal_residual_J")), 1e-10 * (heat + std::abs(value_of(row, "column_heat_J"))));
    EXPECT_LT(std::abs(value_of(row, "column_water_residual_kg")), 1e-12 * value_of(row, "column_water_kg"));
    EXPECT_LE(value_of(row, "band_max_pressure_ratio"), 1.0);
    EXPECT_NEAR(value_of(row, "base_area_m2"), Dim == 2 ? 200.0 : 200.0 * 40.0, Dim == 2 ? 21.0 : 21.0 * 40.0);
  }
  EXPECT_GE(value_of(history_row(simulation), "band_max_temperature_C"),
            value_of(history_row(simulation), "band_temperature_C"));
  EXPECT_GT(value_of(history_row(simulation), "band_saturation"), 0.5);
}

TEST(BandColumns, LoseNeitherHeatNorWater2D) { expect_balances<2>(); }
TEST(BandColumns, LoseNeitherHeatNorWater3D) { expect_balances<3>(); }

// A slab keeps its shape: the base in its middle agrees with that of the rigid block, through melting and boiling. Its
// toe carries more load.
TEST(BandColumns, UnderASlabAgreeWithThoseOfTheBlock) {
  const config::Case parameters =
      case_from_text(column_slab(),
                     "time.end=6.0; time.history_interval=6.0; body.slab.max=[400.0, 80.0]; "
                     "grid.max=[800.0, 160.0]; body.slab.temperature=-0.1; body.slab.velocity=[10.0, 0.0]; "
                     "basal.friction_angle=35.0");
  Simulation<2> simulation(parameters);
  run_until(simulation, 6.0);
  const HistoryRow block = run_block(parameters).back();
  const auto expect_middle = [&](const char* name, const auto& of, double start) {
    const double middle =
        median_over_base(simulation, [&](const auto& segment) { return of(band::current_means(segment)); });
    EXPECT_NEAR(middle - start, value_of(block, name) - start, 0.02 * (value_of(block, name) - start)) << name;
  };
  EXPECT_NEAR(value_of(history_row(simulation), "mean_velocity_m_s"), value_of(block, "velocity_m_s"),
              0.01 * value_of(block, "velocity_m_s"));
  EXPECT_GT(value_of(block, "band_pore_pressure_Pa"), 1e5);
  expect_middle(
      "band_temperature_C", [](const auto& means) { return means.temperature; }, -0.1);
  expect_middle(
      "band_pore_pressure_Pa", [](const auto& means) { return means.pore_pressure; }, 0.0);
}

// Sums and extremes over segments, of which one has a cell that has boiled dry.
TEST(BandColumns, SumsAreThoseOfTheSegments) {
  using Cells = physics::ColumnCells;
  Simulation<2> simulation(case_from_text(column_slab(), "body.slab.velocity=[30.0, 0.0]"));
  run_until(simulation, 1.0);
  const auto& columns = *simulation.band_columns();
  std::vector<band::BasalSegment<2>> segments(columns.segments().begin(), columns.segments().end());
  segments[3].column.water[1] = 0.0;
  segments[3].column.temperature[Cells::ground + 1] = 400.0;
  std::vector<band::BaseSums> parts(segments.size());
  const band::SumSegment<2> kernel{columns.model(), segments.data(), parts.data()};
  band::BaseSums sums;
  double area = 0, thickness = 0, load = 0, wettest = -HUGE_VAL, ratio = 0;
  for (std::size_t p = 0; p < segments.size(); ++p) {
    kernel(p);
    sums += parts[p];
    const physics::BandColumn& column = segments[p].column;
    area += segments[p].area;
    thickness += segments[p].area * column.thickness;
    load += segments[p].area * segments[p].load;
    for (int k = 0; k < Cells::slide; ++k) {
      wettest = std::max(wettest, p == 3 && k == 1 ? wettest : column.temperature[Cells::ground + k]);
      ratio = std::max(ratio, column.pressure[k] / segments[p].load);
    }
  }
  EXPECT_EQ(sums.dry_area, segments[3].area);
  EXPECT_EQ(sums.boiled_dry, 1u);
  EXPECT_EQ(sums.max_temperature, 400.0);
  EXPECT_EQ(sums.max_wet_temperature, wettest);
  EXPECT_EQ(sums.max_pressure_ratio, std::min(ratio, 1.0));
  EXPECT_NEAR(sums.mean(sums.thickness), thickness / area, 1e-12 * thickness / area);
  EXPECT_NEAR(sums.mean(sums.load), load / area, 1e-12 * load / area);
}

// On ground as steep as 84 degrees, a cell of the lattice extends over ten cells of the grid. Every node in contact
// must find a basal segment; otherwise friction heat is lost.
TEST(BandColumns, LoseNoHeatOnSteepGround) {
  Simulation<2> simulation(case_from_text(
      column_slab(),
      "case.gravity_tilt=0.0; terrain.type=plane; terrain.slope=64; grid.cell=5.0; time.stepping=adaptive; "
      "grid.min=[-40.0, -300.0]; grid.max=[100.0, 60.0]; body.slab.shape=polygon; "
      "body.slab.vertices=[[0.0, 0.0], [43.837, -89.879], [61.813, -81.112], [17.976, 8.767]]; "
      "body.slab.velocity=[4.3837, -8.9879]; basal.friction_angle=60.0; basal.distance_check=false"));
  run_until(simulation, 1.5);
  const HistoryRow row = history_row(simulation);
  EXPECT_GT(value_of(row, "friction_heat_J"), 1e6);
  EXPECT_LT(std::abs(value_of(row, "thermal_residual_J")), 1e-9 * value_of(row, "friction_heat_J"));
  EXPECT_GT(simulation.band_columns()->segments().size(), 10U);
}

// Columns are implicit, so the step limits of particles do not apply to them.
TEST(BandColumns, AllowThinBandsAndLargeConductivitiesAtAnyStep) {
  for (const char* hard : {"band.thickness=0.01", "material.rock.hydraulic_conductivity=1e-5"}) {
    Simulation<2> simulation(case_from_text(column_slab(), {hard}));
    EXPECT_EQ(simulation.step_limit().what.rfind("the elastic wave", 0), 0U) << simulation.step_limit().what;
    run_until(simulation, 0.5);
    const HistoryRow row = history_row(simulation);
    EXPECT_GT(value_of(row, "band_temperature_C"), -1.0) << hard;
    EXPECT_LT(std::abs(value_of(row, "thermal_residual_J")), 1e-9 * std::abs(value_of(row, "column_heat_J"))) << hard;
  }
}

// Spreading flow: material enters columns from above as their area grows, and the material per square metre is
// constant.
TEST(BandColumns, SegmentsOfASpreadingSlideGrowAndSplit) {
  Simulation<2> simulation(
      case_from_text(column_slab(),
                     "time.end=4.0; basal.friction_angle=1.0; case.gravity_tilt=0.0; body.slab.velocity=[0,0]; "
                     "material.rock.youngs_modulus=1e6"));
  auto& particles = simulation.particles();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    particles.velocity(p, 0) = 0.2 * (particles.position(p, 0) - 160.0);
  }
  run_until(simulation, 0.5);
  const std::size_t before = simulation.band_columns()->segments().size();
  const double area = simulation.base_totals().sums.area, water = simulation.base_totals().sums.water;
  const double intake = value_of(history_row(simulation), "column_intake_kg");
  run_until(simulation, 3.0);
  const double grown = simulation.base_totals().sums.area / area;
  double first = 1e9, last = -1e9;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    first = std::min(first, particles.position(p, 0));
    last = std::max(last, particles.position(p, 0));
  }
  EXPECT_NEAR(grown, (last - first + 5.0) / (200.0 * std::exp(0.2 * 0.5)), 0.08 * grown);
  EXPECT_GT(simulation.band_columns()->segments().size(), before + 5);
  const HistoryRow row = history_row(simulation);
  const double gained = (grown - 1.0) * water;  // with the initial ice per square metre
  EXPECT_GT(gained, 0.3 * water);
  EXPECT_NEAR(value_of(row, "column_intake_kg") - intake, gained, 0.01 * gained);
  EXPECT_LT(std::abs(value_of(row, "column_water_residual_kg")), 1e-12 * value_of(row, "column_water_kg"));
}

// Contracting flow: basal segments crowd and small ones merge, until their number is close to that of the cells of the
// base. Losses at the top plus the remaining material equal the initial material.
TEST(BandColumns, SegmentsOfAShorteningSlideMerge) {
  using Which = std::pair<int, std::string>;  // 3 m: columns as tall as the slide, each with its ratio of cells
  for (const auto& [dimension, thickness] : {Which{2, "0.1"}, Which{3, "0.1"}, Which{2, "3.0"}}) {
    SCOPED_TRACE(fmt::format("{}D, {} m", dimension, thickness));
    const auto come_together = [](auto& simulation) {
      auto& particles = simulation.particles();
      for (std::size_t p = 0; p < particles.size(); ++p) {
        particles.velocity(p, 0) = -0.25 * (particles.position(p, 0) - 160.0);
      }
      run_until(simulation, 0.5);
      const std::size_t before = simulation.band_columns()->segments().size();
      const double area = simulation.base_totals().sums.area;
      run_until(simulation, 3.0);
      const double shortened = simulation.base_totals().sums.area / area;
      EXPECT_LT(shortened, 0.8);
      EXPECT_LT(static_cast<double>(simulation.band_columns()->segments().size()), 0.85 * static_cast<double>(before));
      const HistoryRow row = history_row(simulation);
      EXPECT_LT(std::abs(value_of(row, "column_water_residual_kg")), 1e-12 * value_of(row, "column_water_kg"));
      EXPECT_LT(std::abs(value_of(row, "thermal_residual_J")), 1e-12 * std::abs(value_of(row, "sensible_J")));
    };
    const config::Case parameters = case_from_text(
        column_slab(dimension),
        {"time.end=4.0", "band.thickness=" + thickness, "guards.smallest_volume=0", "basal.friction_angle=1.0",
         "case.gravity_tilt=0.0", "body.slab.velocity=[0" + std::string(dimension == 3 ? ",0,0]" : ",0]"),
         "material.rock.youngs_modulus=1e6"});
    if (dimension == 2) {
      Simulation<2> simulation(parameters);
      come_together(simulation);
    } else {
      Simulation<3> simulation(parameters);
      come_together(simulation);
    }
  }
}

// Heights of columns [m].
template <class Simulation>
std::vector<double> heights_in(const Simulation& simulation) {
  std::vector<double> heights;
  for (const auto& segment : simulation.band_columns()->segments()) {
    const physics::ColumnGrid grid(segment.column.thickness, segment.column.cell_growth, 1.0, 1.0);
    heights.push_back(grid.face(physics::ColumnCells::slide));
  }
  return heights;
}

// With a band 3 m thick, full columns would be 76 m tall below a slab of 40 m. They end at its surface, and together
// contain no more ice and water than the slab.
TEST(BandColumns, AreNoTallerThanTheSlide) {
  Simulation<2> simulation(case_from_text(column_slab(), "band.thickness=3.0; body.slab.velocity=[0.0, 0.0]"));
  run_until(simulation, 2.0);
  const double middle = median_over_base(simulation, [](const auto& segment) { return segment.depth; });
  EXPECT_NEAR(middle, 40.0, 2.0) << "N over rho g cos(30 degrees)";
  const std::vector<double> heights = heights_in(simulation);
  for (std::size_t p = 0; p < heights.size(); ++p) {
    const auto& segment = simulation.band_columns()->segments()[p];
    EXPECT_NEAR(heights[p], std::clamp(segment.depth, 7.5, 76.1), 0.01 * heights[p]);
  }
  const HistoryRow row = history_row(simulation);
  const double of_slide = value_of(row, "ice_kg") + value_of(row, "water_kg");
  EXPECT_LT(value_of(row, "column_water_kg"), 1.03 * of_slide);
  EXPECT_GT(value_of(row, "column_water_kg"), 0.9 * of_slide);
  EXPECT_LT(std::abs(value_of(row, "column_water_residual_kg")), 1e-12 * value_of(row, "column_water_kg"));
  EXPECT_LT(std::abs(value_of(row, "thermal_residual_J")), 1e-10 * std::abs(value_of(row, "column_heat_J")));
}

// Below a slide deeper than a full column, all cells grow by the same ratio, bitwise identical.
TEST(BandColumns, AreFullBelowADeepSlide) {
  Simulation<2> simulation(case_from_text(column_slab()));
  run_until(simulation, 1.0);
  for (const auto& segment : simulation.band_columns()->segments()) {
    if (segment.position[0] > 80.0 && segment.position[0] < 260.0) {
      EXPECT_EQ(segment.column.cell_growth, 1.4);
    }
  }
}

// The column below the rigid block is as tall as the block is thick, for any load.
TEST(BandColumns, BelowABlockAreAsTallAsItIsThick) {
  band::ColumnsModel model;
  model.column = physics::make_model();
  model.body_temperature = model.ground_temperature = -10.0;
  model.load_time = 1.0;
  model.rock_density = 2750.0;
  model.largest_thickness = 11.0;
  BlockBandColumn column(model, 1.35, 2e5, 0.05);
  for (int step = 0; step < 100; ++step) {
    column.step({0.0, 8e5, 10.0, 10.0, 1.35, 0.05});
    const physics::ColumnGrid grid(1.35, column.segment().column.cell_growth, 1.0, 1.0);
    EXPECT_NEAR(grid.face(physics::ColumnCells::slide), 11.0, 1e-9);
  }
}

// The base data in snapshots average to the values of the history.
TEST(BandColumns, AreListedInATable) {
  Simulation<3> simulation(case_from_text(column_slab(3), {"grid.min=[-100.0, 0.0, -20.0]"}));
  run_until(simulation, 1.0);
  const NamedNumbers table = base_table(simulation);
  const std::vector<double>&areas = table.at("area_m2"), &places = table.at("position_m");
  ASSERT_EQ(places.size(), 3 * areas.size());
  double area = 0.0, pressure = 0.0, hottest = -100.0, lowest = 1e9;
  for (std::size_t k = 0; k < areas.size(); ++k) {
    area += areas[k];
    pressure += areas[k] * table.at("normal_pressure_Pa")[k];
    hottest = std::max(hottest, table.at("max_temperature_C")[k]);
    lowest = std::min(lowest, places[3 * k]);
    EXPECT_NEAR(places[3 * k + 2], 0.0, 1e-9) << "on the ground";
    EXPECT_LE(table.at("pore_pressure_Pa")[k], table.at("normal_pressure_Pa")[k]);
    EXPECT_GT(table.at("slip_m")[k], 0.0);
  }
  const HistoryRow row = history_row(simulation);
  EXPECT_NEAR(area, value_of(row, "base_area_m2"), 1e-9 * area);
  EXPECT_NEAR(pressure / area, value_of(row, "band_normal_pressure_Pa"), 1e-9 * pressure / area);
  EXPECT_EQ(hottest, value_of(row, "band_max_temperature_C"));
  EXPECT_GT(lowest, 0.0) << "in the user's coordinates";
  EXPECT_TRUE(base_table(Simulation<2>(case_from_text(column_slab(), {"band.model=scaled"}))).empty());
}

TEST(BandColumns, AreBitwiseIdenticalOnAnyThreadsAndThroughACheckpoint) {
  const config::Case parameters = case_from_text(column_slab(3));
  const auto visit = [](const Simulation<3>& simulation, int step) {
    EXPECT_TRUE(step == 0 || !simulation.band_columns()->segments().empty());
  };
  expect_reproducible_run<3>([&] { return std::make_unique<Simulation<3>>(parameters); }, 120, {{3, 7, -1}, {1, 0, 60}},
                             visit);
}

TEST(BandColumns, RefuseABandThickerThanTheSlideAndSpuriousHeatOrWater) {
  EXPECT_THROW((Simulation<2>(case_from_text(column_slab(), {"band.thickness=45.0"}))), UserError);
  for (const char* set : {"pressure.frozen=ice_pressure", "pressure.frozen_rows=draining",
                          "pressure.melt_contraction=false", "band.thickness_change=as_published"}) {
    EXPECT_THROW(case_from_text(column_slab(), {set}), UserError) << set;
  }
}

}  // namespace
}  // namespace thawslide::sim
