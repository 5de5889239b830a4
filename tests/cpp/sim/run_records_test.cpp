// Records of a 3D run: probes compared with the maps and the particles, the front along a path, figures, resuming.
#include "sim/records/run_records.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "../support/base_cases.hpp"
#include "../support/messages.hpp"
#include "../support/two_bodies.hpp"
#include "io/checkpoint.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

constexpr auto level_ground = [](double /*x*/, double /*y*/) { return 0.0; };

TEST(Section, PartsAreDividedBetweenThePointsOfTheMaps) {
  const MapGrid grid{0.5, 1.0, 1.0, 2.0, 10, 10, ""};  // points at half metres along x, at odd ones along y
  const auto parts = parts_of_section({{0.5, 1.0}, {3.0, 1.0}, {3.0, 4.0}}, grid);
  ASSERT_EQ(parts.size(), 5u);
  const std::vector<std::array<double, 5>> expected{{1.0, 0.5, 1.0, 0, -1},
                                                    {2.0, 0.5, 1.0, 0, -1},
                                                    {2.75, 0.5, 0.5, 0, -1},
                                                    {3.0, 1.0, 2.0, 1, 0},
                                                    {3.0, 1.75, 1.0, 1, 0}};
  for (std::size_t k = 0; k < parts.size(); ++k) {
    EXPECT_NEAR(parts[k].column, expected[k][0], 1e-12);
    EXPECT_NEAR(parts[k].row, expected[k][1], 1e-12);
    EXPECT_NEAR(parts[k].length, expected[k][2], 1e-12);
    EXPECT_NEAR(parts[k].normal_x, expected[k][3], 1e-12);
    EXPECT_NEAR(parts[k].normal_y, expected[k][4], 1e-12);
  }
}

TEST(Section, ObliquePartsSumToItsLength) {
  const MapGrid grid{0.5, 1.0, 1.0, 2.0, 20, 20, ""};
  double length = 0.0, column = 0.0;
  for (const SectionPart& part : parts_of_section({{0.3, 0.1}, {17.1, 33.7}}, grid)) {
    length += part.length;
    EXPECT_GE(part.column, column);
    column = part.column;
    EXPECT_NEAR(part.normal_x * 16.8 + part.normal_y * 33.6, 0.0, 1e-12);
    EXPECT_GT(part.normal_x, 0.0);  // to the right of a line to the north-east
  }
  EXPECT_NEAR(length, std::hypot(16.8, 33.6), 1e-12);
}

TEST(Section, OnTheLastBorderBelongsToTheCellsBeforeIt) {
  const MapGrid grid{0.5, 0.5, 1.0, 1.0, 3, 2, ""};
  EXPECT_TRUE(grid.contains(3.0, 2.0));
  EXPECT_FALSE(grid.contains(3.001, 2.0));
  for (const SectionPart& part : parts_of_section({{0.0, 2.0}, {3.0, 2.0}}, grid)) {
    EXPECT_EQ(part.row, 2.0);
    EXPECT_LT(part.column, 3.0);
  }
  EXPECT_EQ(grid.cell_column(grid.column_of(3.0)), 2);
}

TEST(Probes, MeasureTheMovingBox) {
  // A box that slides as a rigid body: the discharge is the product of thickness, width and speed.
  const Simulation<3> simulation(slide_in_space("body.box.velocity=[8,0,0]"));
  config::Site site;
  site.probes = {{"gauge", {{3.5, 4.5}}},
                 {"empty", {{30.5, 4.5}}},
                 {"section", {{3.5, 15.0 - 1e-9}, {3.5, -4.5}}},
                 {"back", {{3.5, -4.5}, {3.5, 14.5}}},
                 {"beyond", {{30.5, -4.5}, {30.5, 14.5}}}};
  RunRecords<3> records(simulation, site);
  records.start(simulation);
  const HistoryRow row = records.probe_row(simulation);
  EXPECT_EQ(row.front().first, "time_s");
  EXPECT_EQ(row.size(), 1u + 2 * 2 + 3 * 4);
  EXPECT_NEAR(value_of(row, "gauge_thickness_m"), 3.0, 1e-12);
  EXPECT_NEAR(value_of(row, "gauge_speed_m_s"), 8.0, 1e-12);
  EXPECT_EQ(value_of(row, "empty_thickness_m"), 0.0);
  EXPECT_EQ(value_of(row, "empty_speed_m_s"), 0.0);
  EXPECT_NEAR(value_of(row, "section_flow_area_m2"), 12.0, 1e-10);
  EXPECT_NEAR(value_of(row, "section_discharge_m3_s"), -96.0, 1e-9);  // the line runs south, so west is to its right
  EXPECT_NEAR(value_of(row, "section_max_thickness_m"), 3.0, 1e-12);
  EXPECT_NEAR(value_of(row, "section_mean_speed_m_s"), 8.0, 1e-9);
  EXPECT_NEAR(value_of(row, "back_discharge_m3_s"), 96.0, 1e-9);
  EXPECT_NEAR(value_of(row, "back_mean_speed_m_s"), 8.0, 1e-9);
  EXPECT_EQ(value_of(row, "beyond_flow_area_m2"), 0.0);
  EXPECT_EQ(value_of(row, "beyond_mean_speed_m_s"), 0.0);
}

TEST(Probes, OutsideTheMapsAreRefused) {
  const Simulation<3> simulation(slide_in_space());
  config::Site site;
  site.probes = {{"gauge", {{3.5, 40.0}}}};
  const auto message = [&] { return error_of([&] { RunRecords<3>(simulation, site); }); };
  expect_in(message(),
            ": probe 'gauge' has a point at x = 3.5 m, y = 40 m, outside the maps; allowed: x from -4 to "
            "60 m, y from -5 to 15 m. Move it, or make the domain larger.");
  site.probes = {{"gauge", {{3.5, 4.0}, {3.5, 4.0}}}};
  expect_in(message(),
            "the line of probe 'gauge' has no length; allowed: one point, or a line of at least two "
            "different ones.");
}

TEST(RunRecords, FrontAlongAStraightPathIsThatOfTheHistory) {
  Simulation<3> simulation(slide_in_space("body.box.velocity=[8,0,0]"));
  config::Site site;
  site.path = {{-2.0, 5.0}, {50.0, 5.0}};
  RunRecords<3> records(simulation, site);
  records.start(simulation);
  for (int k = 0; k < 30; ++k) {
    simulation.step(0.002);
    records.after_step(simulation);
  }
  const auto front = records.front(simulation);
  ASSERT_TRUE(front.has_value());
  EXPECT_NEAR(front->along, front_position(simulation) + 2.0, 1e-12);
  EXPECT_NEAR(front->position[0], front_position(simulation), 1e-12);
  const HistoryRow row = records.history_row(simulation), along_x = history_row(simulation);
  ASSERT_EQ(row.size(), along_x.size());
  for (std::size_t k = 0; k < row.size(); ++k) {
    EXPECT_EQ(row[k].first, along_x[k].first);
    if (row[k].first == "front_position_m") {
      EXPECT_EQ(row[k].second, front->along);
    } else if (row[k].first == "runout_m") {
      EXPECT_NEAR(row[k].second, along_x[k].second, 1e-12);  // from the edge of the body
    } else {
      EXPECT_EQ(std::memcmp(&row[k].second, &along_x[k].second, sizeof(double)), 0) << row[k].first;
    }
  }
  const auto figures = records.figures(simulation, level_ground);
  ASSERT_TRUE(figures.has_value());
  EXPECT_EQ(figures->front_distance, front->along);
  EXPECT_NEAR(figures->travel_distance, front->position[0], 1e-12);
  EXPECT_NEAR(figures->drop_height, 3.0, 1e-12);
  EXPECT_EQ(figures->reach_angle, angle_of_reach(figures->drop_height, figures->travel_distance));
  EXPECT_NEAR(figures->covered_volume, 72.0, 0.5);
  const auto on_slope = records.figures(simulation, [](double x, double y) { return 0.25 - 0.1 * x + 0.01 * y; });
  EXPECT_NEAR(on_slope->drop_height, 2.75 + 0.1 * front->position[0] - 0.01 * front->position[1], 1e-12);
  simulation.particles().resize(0);
  EXPECT_FALSE(records.front(simulation).has_value());
}

TEST(RunRecords, UseThePathOfTheCentreOfMassByDefault) {
  Simulation<3> simulation(slide_in_space("body.box.velocity=[0,-16,0]; case.gravity_tilt=0.0"));
  RunRecords<3> records(simulation, {});
  records.start(simulation);
  EXPECT_FALSE(records.path_given());
  EXPECT_TRUE(records.path().empty());
  EXPECT_FALSE(records.front(simulation).has_value());
  EXPECT_TRUE(std::isnan(value_of(records.history_row(simulation), "runout_m")));
  const auto at_rest = records.figures(simulation, level_ground);
  ASSERT_TRUE(at_rest.has_value());
  EXPECT_TRUE(std::isnan(at_rest->travel_distance));
  EXPECT_NEAR(at_rest->covered_volume, 72.0, 1e-10);
  EXPECT_NEAR(at_rest->covered_area, 24.0, 1e-10);
  EXPECT_NEAR(at_rest->affected_area, 24.0, 1e-10);
  for (int k = 0; k < 100; ++k) {
    simulation.step(0.002);
    records.after_step(simulation);
  }
  ASSERT_FALSE(records.path().empty());
  EXPECT_NEAR(records.path().corners()[0][0], 3.0, 1e-12);
  EXPECT_NEAR(records.path().corners()[0][1], 5.0, 1e-12);
  EXPECT_NEAR(records.path().corners().back()[0], 3.0, 0.02);
  EXPECT_NEAR(records.path().length(), 3.0, 0.3);
  const auto front = records.front(simulation);
  ASSERT_TRUE(front.has_value());
  EXPECT_NEAR(front->along, 5.0 - front->position[1], 0.05);
  EXPECT_NEAR(records.figures(simulation, level_ground)->travel_distance, 7.0 - front->position[1], 0.05);
}

TEST(RunRecords, KeepPeakValuesAfterTheSlideHasLeft) {
  Simulation<3> simulation(slide_in_space("body.box.velocity=[8,0,0]"));
  config::Site site;
  site.probes = {{"gauge", {{3.5, 4.5}}}};
  RunRecords<3> records(simulation, site);
  records.start(simulation);
  records.slide_left();
  EXPECT_EQ(records.maps()->covered_volume(0.1), 0.0);
  EXPECT_EQ(value_of(records.probe_row(simulation), "gauge_thickness_m"), 0.0);
  EXPECT_EQ(value_of(records.probe_row(simulation), "gauge_speed_m_s"), 0.0);
  const MapGrid& grid = records.maps()->map_grid();
  const MapCell& cell = records.maps()->cell(grid.cell_column(grid.column_of(3.5)), grid.cell_row(grid.row_of(4.5)));
  EXPECT_NEAR(cell.max_thickness, 3.0, 1e-12);
  EXPECT_NEAR(cell.thickness_at_start, 3.0, 1e-12);
}

TEST(RunRecords, AreBitwiseIdenticalAfterAStopAndAResume) {
  const config::Case parameters = slide_in_space("body.box.velocity=[8,1,0]");
  config::Site site;
  site.probes = {{"gauge", {{7.5, 5.5}}}, {"section", {{7.5, 0.0}, {8.5, 10.0}}}};
  const auto steps = [](Simulation<3>& simulation, RunRecords<3>& records, int count) {
    for (int k = 0; k < count; ++k) {
      simulation.step(0.002);
      records.after_step(simulation);
    }
  };
  Simulation<3> whole(parameters);
  RunRecords<3> of_whole(whole, site);
  of_whole.start(whole);
  steps(whole, of_whole, 40);
  const std::filesystem::path folder = testing_support::folder_of_this_test();
  io::write_checkpoint<3>(folder, whole.particles(), whole.particles_at_start(), whole.scalars(), of_whole.state());
  const HistoryRow probes_then = of_whole.probe_row(whole);
  steps(whole, of_whole, 60);

  Simulation<3> resumed(parameters);
  std::vector<double> scalars;
  RunRecords<3> of_resumed(resumed, site);
  of_resumed.restore(io::read_checkpoint<3>(io::newest_checkpoint(folder), resumed.particles(), scalars));
  resumed.restore(scalars);
  EXPECT_EQ(of_resumed.probe_row(resumed), probes_then);
  steps(resumed, of_resumed, 60);

  const NamedNumbers expected = of_whole.state(), found = of_resumed.state();
  ASSERT_EQ(expected.size(), found.size());
  for (const auto& [name, numbers] : expected) {
    ASSERT_EQ(found.at(name).size(), numbers.size()) << name;
    EXPECT_EQ(std::memcmp(found.at(name).data(), numbers.data(), numbers.size() * sizeof(double)), 0) << name;
  }
  EXPECT_EQ(of_resumed.probe_row(resumed), of_whole.probe_row(whole));
  EXPECT_EQ(named(*of_resumed.figures(resumed, level_ground)), named(*of_whole.figures(whole, level_ground)));
}

TEST(RunRecords, AreEmptyInThePlane) {
  const Simulation<2> simulation(testing_support::two_bodies<2>(5e3));
  config::Site site;
  site.path = {{0.0, 0.0}, {1.0, 0.0}};
  RunRecords<2> records(simulation, site);
  records.start(simulation);
  records.after_step(simulation);
  EXPECT_EQ(records.maps(), nullptr);
  EXPECT_TRUE(records.path().empty());
  EXPECT_FALSE(records.path_given());
  EXPECT_FALSE(records.front(simulation).has_value());
  EXPECT_TRUE(records.state().empty());
  EXPECT_TRUE(records.probe_row(simulation).empty());
  EXPECT_EQ(value_of(records.history_row(simulation), "front_position_m"), front_position(simulation));
  EXPECT_FALSE(records.figures(simulation, level_ground).has_value());
}

}  // namespace
}  // namespace thawslide::sim
