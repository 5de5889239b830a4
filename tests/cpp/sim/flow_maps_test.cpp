// Maps of a 3D slide: fractions of boxes, sums, peak values, independence of threads and of the order in memory; stored
// ground.
#include "sim/maps/flow_maps.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>

#include "../support/base_cases.hpp"
#include "base/parallel.hpp"
#include "sim/simulation.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::sim {
namespace {

using testing_support::slide_in_space;

double volume_of(const mpm::Particles<3>& particles) {
  double volume = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    volume += particles.volume(p);
  }
  return volume;
}

double map_volume(const FlowMaps& maps) {
  double volume = 0.0;
  maps.for_cells([&](int, int, const MapCell& cell) { volume += cell.thickness * maps.map_grid().cell_area(); });
  return volume;
}

FlowMaps maps_of(const Simulation<3>& simulation, const MapGrid& map_grid, double arrival_thickness = 0.1) {
  const auto& origin = simulation.model().origin;
  return {map_grid,
          {origin[0], origin[1]},
          {simulation.model().motion.sizes.half(0) * simulation.grid().cell()},
          arrival_thickness};
}

void start(FlowMaps& maps, const Simulation<3>& simulation) { maps.start(*simulation.sample_map(maps.cells())); }
void gather(FlowMaps& maps, const Simulation<3>& simulation) {
  maps.gather(*simulation.sample_map(maps.cells()), simulation.time());
}

const MapKind& kind(const std::string& name) {
  for (const MapKind& map : map_kinds()) {
    if (map.name == name) {
      return map;
    }
  }
  throw std::logic_error("no map " + name);
}

// Fractions of a box along an axis of ten cells.
mpm::CellRange cells_below(double middle, double half) {
  return mpm::cell_spans(middle, half, 0.5 / half, 10).of_lane(0);
}

void expect_range(const mpm::CellRange& found, int first, const std::vector<double>& fractions) {
  ASSERT_EQ(found.first, first);
  ASSERT_EQ(found.last, first + static_cast<int>(fractions.size()) - 1);
  for (std::size_t k = 0; k < fractions.size(); ++k) {
    EXPECT_NEAR(found.fraction(first + static_cast<int>(k)), fractions[k], fractions.size() > 1 ? 1e-15 : 0.0);
  }
}

TEST(CellRange, FractionsFollowFromTheBoxAndSumToOne) {
  expect_range(cells_below(2.5, 0.25), 2, {1.0});
  expect_range(cells_below(3.1, 0.5), 2, {0.4, 0.6});
  expect_range(cells_below(4.25, 1.5), 2, {0.25 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 0.75 / 3.0});
  for (const double off : {0.0, 1e-13, -1e-13}) {
    expect_range(cells_below(2.5 + off, 0.5), 2, {1.0});  // ends at borders
  }
  expect_range(cells_below(0.2, 0.5), 0, {1.0});  // parts outside are assigned to the edge
  expect_range(cells_below(9.2, 1.0), 8, {0.4, 0.6});
}

// Two billion cells of maps would take 200 GB.
TEST(FlowMaps, MemoryFollowsTheSlideAndTheCells) {
  const Simulation<3> simulation(slide_in_space());
  FlowMaps wide = maps_of(simulation, {-4.5, -4.5, 1.5, 1.0, 60, 20, ""});
  FlowMaps fine = maps_of(simulation, {-299.975, -299.975, 0.05, 0.05, 40000, 50000, ""});
  EXPECT_EQ(wide.bytes(), 0U);
  start(wide, simulation);
  start(fine, simulation);
  EXPECT_LE(wide.bytes(),
            5U * 16 * 16 * FlowMaps::bytes_of_cell());  // 60 x 20 cells are 4 x 2 tiles, not all of them near the slide
  EXPECT_GT(fine.bytes(), 10U * wide.bytes());
  int cells = 0;
  fine.for_cells([&](int, int, const MapCell&) { ++cells; });
  EXPECT_EQ(cells, 120 * 80);
  const Raster raster = fine.raster(kind("max_thickness"), MapExtent::slide);
  EXPECT_EQ(raster.columns, 120);
  EXPECT_EQ(raster.rows, 80);
  EXPECT_NEAR(raster.x, 0.025, 1e-9);
}

TEST(FlowMaps, ABoxGivesItsThicknessFromTheStart) {
  const Simulation<3> simulation(slide_in_space());
  // Cells of 1.5 x 1 m starting at -5.25 m: along x, the box begins and ends in the middle of one.
  FlowMaps maps = maps_of(simulation, {-4.5, -4.5, 1.5, 1.0, 60, 20, ""});
  start(maps, simulation);
  int cells = 0;
  maps.for_cells([&](int, int row, const MapCell& cell) {
    ++cells;
    EXPECT_GE(row, 8);
    EXPECT_LE(row, 11);
    EXPECT_EQ(cell.thickness, cell.thickness_at_start);
    EXPECT_EQ(cell.thickness, cell.max_thickness);
    EXPECT_EQ(cell.arrival_time, 0.0);
    EXPECT_EQ(cell.max_speed, 0.0);
  });
  EXPECT_EQ(cells, 5 * 4);
  EXPECT_NEAR(maps.cell(3, 8).thickness, 3.0 * 0.75 / 1.5, 1e-12);
  EXPECT_NEAR(maps.cell(4, 8).thickness, 3.0, 1e-12);
  EXPECT_NEAR(maps.cell(7, 11).thickness, 3.0 * 0.75 / 1.5, 1e-12);
  EXPECT_TRUE(std::isnan(maps.cell(8, 8).max_speed));
  EXPECT_NEAR(maps.covered_volume(maps.arrival_thickness()), 72.0, 1e-10);
  EXPECT_NEAR(maps.covered_cells(0.1).area(), 24.0, 1e-12) << "half of two columns of cells, and not all of them";
  EXPECT_NEAR(maps.affected_cells(0.1).area(), 24.0, 1e-12);
  EXPECT_EQ(maps.covered_cells(3.5).area(), 0.0) << "no cell is as thick";
  EXPECT_EQ(maps.affected_cells(3.5).area(), 0.0);
}

// Contents of each cell compared with the overlap of all boxes with it.
TEST(FlowMaps, CellsContainTheirFractionsOfAllBoxes) {
  Simulation<3> simulation(slide_in_space("body.box.velocity=[6,2,0.5]; body.box.particles_per_axis=3"));
  const double half = 0.5 / 3.0;
  for (const MapGrid& grid :
       {MapGrid{-4.1, -5.2, 0.13, 0.21, 500, 100, ""}, MapGrid{-4.0, -5.0, 0.7, 0.9, 100, 30, ""}}) {
    FlowMaps maps = maps_of(simulation, grid);
    start(maps, simulation);
    for (int k = 0; k < 15; ++k) {
      simulation.step(0.002);
      gather(maps, simulation);
    }
    const auto& particles = simulation.particles();
    const auto& origin = simulation.model().origin;
    const auto fraction = [&](double place, double point, double cell) {
      const double from = std::max(place - half, point - 0.5 * cell), to = std::min(place + half, point + 0.5 * cell);
      return std::max(0.0, to - from) / (2.0 * half);
    };
    int cells = 0;
    maps.for_cells([&](int column, int row, const MapCell& cell) {
      double volume = 0.0, mass = 0.0;
      Vector<double, 3> momentum = Vector<double, 3>::Zero();
      for (std::size_t p = 0; p < particles.size(); ++p) {
        const double part = fraction(particles.position(p, 0) + origin[0], grid.x + column * grid.cell_x, grid.cell_x) *
                            fraction(particles.position(p, 1) + origin[1], grid.y + row * grid.cell_y, grid.cell_y);
        volume += part * particles.volume(p);
        mass += part * particles.mass(p);
        momentum += part * particles.mass(p) * particles.velocity.get<Vector<double, 3>>(p);
      }
      ASSERT_NEAR(cell.thickness, volume / grid.cell_area(), 1e-6);
      if (cell.thickness > 1e-3) {
        ++cells;
        ASSERT_NEAR(cell.velocity_x, momentum[0] / mass, 1e-6);
        ASSERT_NEAR(cell.velocity_y, momentum[1] / mass, 1e-6);
        ASSERT_NEAR(cell.velocity_z, momentum[2] / mass, 1e-6);
      }
    });
    EXPECT_GT(cells * grid.cell_area(), 24.0);
  }
}

// Each peak value compared with the particles above one cell so large that it contains all of them.
TEST(FlowMaps, PeakValuesAreTheMaximaOfTheColumn) {
  Simulation<3> simulation(slide_in_space("body.box.velocity=[5,0,0]"));
  FlowMaps maps = maps_of(simulation, {28.0, 5.0, 64.0, 20.0, 1, 1, ""});
  FlowMaps of_thin = maps_of(simulation, maps.map_grid(), 0.05);  // the cell's thickness is 72/1280 m
  start(maps, simulation);
  start(of_thin, simulation);
  const double area = 64.0 * 20.0;
  double speed = 0.0, flux = 0.0, pressure = 0.0, temperature = -HUGE_VAL, melt = 0.0, pore = -HUGE_VAL,
         time_of_pressure = -1.0;
  const auto record = [&] {
    const auto& particles = simulation.particles();
    Vector<double, 3> momentum = Vector<double, 3>::Zero();
    double mass = 0.0, water = 0.0, band = 0.0, warm = 0.0, pressed = 0.0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      mass += particles.mass(p);
      momentum += particles.mass(p) * particles.velocity.get<Vector<double, 3>>(p);
      water +=
          particles.porosity(p) * particles.liquid_saturation(p) * particles.volume(p) / particles.thermal_scaling(p);
      if (particles.in_band(p) != 0) {
        band += particles.volume(p);
        warm += particles.volume(p) * particles.temperature(p);
        pressed += particles.volume(p) * particles.pore_pressure(p);
      }
    }
    const double volume = volume_of(particles), v = momentum.norm() / mass;
    speed = std::max(speed, v);
    flux = std::max(flux, volume / area * v * v);
    if (mass / volume * v * v > pressure) {
      pressure = mass / volume * v * v;
      time_of_pressure = simulation.time();
    }
    temperature = std::max(temperature, warm / band);
    melt = std::max(melt, water / area);
    pore = std::max(pore, pressed / band);
  };
  record();
  for (int k = 0; k < 60; ++k) {
    simulation.step(0.002);
    gather(maps, simulation);
    gather(of_thin, simulation);
    record();
  }
  EXPECT_EQ(maps.covered_cells(0.1).area(), 0.0);
  EXPECT_TRUE(std::isnan(maps.cell(0, 0).max_speed));
  EXPECT_TRUE(std::isnan(maps.cell(0, 0).max_pressure));
  EXPECT_TRUE(std::isnan(maps.cell(0, 0).arrival_time));
  const auto value = [&](const char* name) { return maps.raster(kind(name), MapExtent::whole_grid).values.at(0); };
  EXPECT_NEAR(value("max_momentum_flux"), flux, 1e-12 * flux);
  EXPECT_NEAR(value("max_basal_temperature"), temperature, 1e-12);
  EXPECT_NEAR(value("max_melt"), melt, 1e-12 * melt);
  EXPECT_GT(melt, 0.0);
  EXPECT_NEAR(value("max_pore_pressure"), pore, 1e-9 * std::abs(pore));
  EXPECT_NE(pore, 0.0);
  EXPECT_EQ(value("elevation_change"), value("final_thickness") - 72.0 / area);
  const MapCell& thin = of_thin.cell(0, 0);
  EXPECT_EQ(thin.arrival_time, 0.0);
  EXPECT_NEAR(thin.max_speed, speed, 1e-12 * speed);
  EXPECT_NEAR(thin.max_pressure, pressure, 1e-12 * pressure);
  EXPECT_EQ(thin.max_pressure_time, time_of_pressure);
  EXPECT_EQ(of_thin.covered_cells(of_thin.arrival_thickness()).area(), area);
}

TEST(FlowMaps, ASlideThatMovesAwayLeavesEmptyCells) {
  Simulation<3> simulation(slide_in_space("body.box.velocity=[40,0,0]; basal.friction_angle=0.0"));
  FlowMaps maps = maps_of(simulation, {-3.75, -4.75, 0.5, 0.5, 128, 40, ""});
  start(maps, simulation);
  while (simulation.time() < 0.8) {
    simulation.step(0.002);
    gather(maps, simulation);
  }
  const double volume = volume_of(simulation.particles());
  EXPECT_NEAR(map_volume(maps), volume, 1e-12 * volume);
  double changed = 0.0;
  for (const double change : maps.raster(kind("elevation_change"), MapExtent::slide).values) {
    changed += std::isnan(change) ? 0.0 : 0.25 * change;
  }
  EXPECT_NEAR(changed, volume - 72.0, 1e-9);
  const MapCell& left = maps.cell(10, 20);  // x = 1.25 m, y = 5.25 m
  EXPECT_EQ(left.thickness, 0.0);
  EXPECT_EQ(left.speed(), 0.0);
  EXPECT_NEAR(left.thickness_at_start, 3.0, 1e-12);
  EXPECT_GE(left.max_thickness, 3.0);
  EXPECT_GT(left.max_speed, 40.0);
  // The box begins at 6 m and reaches 16.25 m after 0.25 s, slightly earlier because gravity accelerates it.
  const double arrival = maps.cell(40, 20).arrival_time;
  EXPECT_GT(arrival, 0.23);
  EXPECT_LT(arrival, 0.256);
}

TEST(FlowMaps, RastersAreLocatedAtTheCells) {
  const Simulation<3> simulation(slide_in_space());
  FlowMaps maps = maps_of(simulation, {-3.5, -4.5, 1.0, 1.0, 64, 20, "a system"});
  EXPECT_TRUE(maps.raster(kind("max_thickness"), MapExtent::slide).empty());
  start(maps, simulation);
  const Raster slide = maps.raster(kind("max_thickness"), MapExtent::slide);
  EXPECT_EQ(slide.columns, 6);
  EXPECT_EQ(slide.rows, 4);
  EXPECT_EQ(slide.x, 0.5);
  EXPECT_EQ(slide.y, 3.5);
  EXPECT_EQ(slide.crs, "a system");
  const Raster whole = maps.raster(kind("max_thickness"), MapExtent::whole_grid);
  EXPECT_EQ(whole.columns, 64);
  EXPECT_EQ(whole.rows, 20);
  int known = 0;
  for (int row = 0; row < whole.rows; ++row) {
    for (int column = 0; column < whole.columns; ++column) {
      const double value = whole.at(column, row);
      known += std::isnan(value) ? 0 : 1;
      if (!std::isnan(value)) {
        EXPECT_NEAR(value, 3.0, 1e-12);
        EXPECT_EQ(value, slide.at(column - 4, row - 8));
      }
    }
  }
  EXPECT_EQ(known, 24);
}

std::vector<double> state_after(const MapGrid& map_grid, int threads, int sorting_interval, int stop_at) {
  const int threads_before = thread_count();
  set_thread_count(threads);
  Simulation<3> simulation(slide_in_space("body.box.velocity=[10,3,1]; body.box.max=[12.0, 11.0, 3.0]"));
  simulation.set_sorting_interval(sorting_interval);
  FlowMaps maps = maps_of(simulation, map_grid);
  start(maps, simulation);
  for (int k = 0; k < 60; ++k) {
    if (k == stop_at) {
      const std::vector<double> state = maps.state();
      maps = maps_of(simulation, maps.map_grid());
      maps.restore(state);
      EXPECT_EQ(std::memcmp(maps.state().data(), state.data(), state.size() * sizeof(double)), 0);
    }
    simulation.step(0.002);
    gather(maps, simulation);
  }
  EXPECT_GE(simulation.grid().tiles().size(), fewest_shared_calls);
  set_thread_count(threads_before);
  return maps.state();
}

TEST(FlowMaps, BitsDependNeitherOnThreadsNorOnMemoryOrderNorOnAStop) {
  // The coarse grid's cells are wider than the background grid's tiles.
  for (const MapGrid& grid :
       {MapGrid{-3.83, -4.83, 0.34, 0.34, 189, 59, ""}, MapGrid{-1.0, -2.0, 6.0, 6.0, 11, 4, ""}}) {
    const std::vector<double> once = state_after(grid, 1, 64, -1);
    for (const auto& [threads, interval, stop] : {std::array{4, 64, -1}, std::array{2, 3, -1}, std::array{3, 0, 37}}) {
      const std::vector<double> again = state_after(grid, threads, interval, stop);
      ASSERT_EQ(again.size(), once.size());
      EXPECT_EQ(std::memcmp(again.data(), once.data(), once.size() * sizeof(double)), 0) << threads;
    }
  }
}

// The stored ground data of the grid follow the slide.
TEST(GroundMemory, IsReleasedBehindTheSlide) {
  Simulation<3> simulation(
      slide_in_space("body.box.velocity=[80,0,0]; grid.max=[200,15,20]; material.rock.law=elastic; "
                     "material.rock.viscosity_time=0.01"));
  std::size_t most_held = 0, most_active = 0, seen = 0;
  for (int k = 0; k < 1000; ++k) {  // about 170 m, nearly thirty times the length of the body
    const std::size_t before = simulation.ground()->stored();
    simulation.step(0.002);
    const std::size_t after = simulation.ground()->stored();
    seen += after > before ? after - before : 0;
    most_held = std::max(most_held, after);
    most_active = std::max(most_active, simulation.grid().blocks().size());
  }
  EXPECT_GT(seen, 3 * most_active);  // the slide has passed over more ground than may be stored
  EXPECT_LE(most_held, 4 * most_active);
}

}  // namespace
}  // namespace thawslide::sim
