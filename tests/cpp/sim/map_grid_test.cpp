// The grid of maps: location of its cells and their maximum number.
#include "sim/maps/map_grid.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "../support/messages.hpp"

namespace thawslide::sim {
namespace {

TEST(MapGrid, IsThatOfTheGroundAndCoversTheDomain) {
  config::Case parameters;
  parameters.grid.cell = 4.0;
  parameters.grid.min = {100.0, 200.0, 0.0};
  parameters.grid.max = {150.0, 230.0, 10.0};
  config::Site site;
  const MapGrid own = map_grid_of(parameters, site);
  EXPECT_EQ(own.x, 102.0);
  EXPECT_EQ(own.columns, 13);  // 50 m
  EXPECT_EQ(own.rows, 8);
  site.crs = "a system";
  site.ground = std::make_shared<Raster>(Raster{101.0, 190.0, 5.0, 10.0, 9, 6, {}, ""});
  const MapGrid grid = map_grid_of(parameters, site);  // cells of the ground: 98.5 to 143.5 m, 185 to 245 m
  EXPECT_EQ(grid.x, 101.0);
  EXPECT_EQ(grid.cell_x, 5.0);
  EXPECT_EQ(grid.columns, 11);
  EXPECT_EQ(grid.y, 190.0);
  EXPECT_EQ(grid.rows, 6);
  EXPECT_EQ(grid.crs, "a system");
  parameters.maps.cell = 2.5;
  parameters.grid.min[0] = 98.0;
  const MapGrid requested = map_grid_of(parameters, site);
  EXPECT_EQ(requested.x, 98.5 - 2.5 + 1.25);
  EXPECT_EQ(requested.columns, 22);  // 96 to 151 m
  EXPECT_EQ(requested.cell_y, 2.5);
  EXPECT_EQ(requested.rows, 24);
}

// A DEM of 5 m and particles 5 m apart: each cell of 5 m would contain one column of particles.
TEST(MapGrid, CellsAreThreeParticleDistancesWideByDefault) {
  config::Case parameters;
  parameters.grid.cell = 10.0;
  parameters.grid.min = {0.0, 0.0, 0.0};
  parameters.grid.max = {500.0, 300.0, 100.0};
  parameters.bodies["fine"].particles_per_axis = 4;
  parameters.bodies["slide"].particles_per_axis = 2;
  config::Site site;
  site.ground = std::make_shared<Raster>(Raster{2.5, 2.5, 5.0, 5.0, 100, 60, {}, ""});
  const MapGrid grid = map_grid_of(parameters, site);
  EXPECT_EQ(grid.cell_x, 15.0);
  EXPECT_EQ(grid.cell_y, 15.0);
  EXPECT_EQ(grid.x, 7.5);  // the cells begin at the corner of the DEM's, 0 m
  EXPECT_EQ(grid.columns, 34);
  EXPECT_EQ(grid.rows, 20);
  EXPECT_EQ(reason_for_map_cell(parameters, site),
            "3 x 3 of the DEM's, to be at least 15 m wide: three particle distances");
  EXPECT_EQ(warning_of_map_cell(parameters, site), "");
  site.ground = std::make_shared<Raster>(Raster{10.0, 2.5, 20.0, 5.0, 25, 60, {}, ""});
  EXPECT_EQ(map_grid_of(parameters, site).cell_x, 20.0);
  EXPECT_EQ(map_grid_of(parameters, site).cell_y, 15.0);
  parameters.maps.cell = 5.0;
  EXPECT_EQ(map_grid_of(parameters, site).cell_x, 5.0);
  EXPECT_EQ(reason_for_map_cell(parameters, site), "as maps.cell asks");
  EXPECT_EQ(warning_of_map_cell(parameters, site),
            "maps.cell is 5 m, and grid.cell 10 m: a map cell contains few particles or only one, and the maximum "
            "speeds and pressures are those of single particles. Without maps.cell, maps have cells of 20 x 15 m.");
  parameters.maps.cell = 10.0;
  EXPECT_EQ(warning_of_map_cell(parameters, site), "");
}

// With four particles per cell and axis, a grid cell is wider than three particle distances. If a DEM is coarser than
// both, its cells are kept.
TEST(MapGrid, CellsAreAtLeastAsWideAsThoseOfGridAndDem) {
  config::Case parameters;
  parameters.grid.cell = 10.0;
  parameters.grid.max = {500.0, 300.0, 100.0};
  parameters.bodies["fine"].particles_per_axis = 4;
  config::Site site;
  EXPECT_EQ(reason_for_map_cell(parameters, site), "as grid.cell");
  EXPECT_EQ(map_grid_of(parameters, site).cell_x, 10.0);
  site.ground = std::make_shared<Raster>(Raster{2.5, 2.5, 4.9977, 4.9977, 100, 60, {}, ""});
  EXPECT_EQ(map_grid_of(parameters, site).cell_x, 3.0 * 4.9977);
  EXPECT_EQ(reason_for_map_cell(parameters, site), "3 x 3 of the DEM's, to be at least 10 m wide: grid.cell");
  site.ground = std::make_shared<Raster>(Raster{2.5, 2.5, 10.0, 10.0, 50, 30, {}, ""});
  EXPECT_EQ(map_grid_of(parameters, site).cell_x, 10.0);
  EXPECT_EQ(reason_for_map_cell(parameters, site), "the DEM's");
}

TEST(MapGrid, OfTooManyCellsIsRefused) {
  config::Case parameters;
  parameters.file = "case.toml";
  parameters.grid.max = {1e5, 1e5, 1e3};
  parameters.maps.cell = 0.1;
  EXPECT_EQ(testing_support::error_of([&] { static_cast<void>(map_grid_of(parameters, {})); }),
            "case.toml: maps of 1000000 x 1000000 cells of 0.1 x 0.1 m are too many: each would take 8,000 GB of "
            "memory while it is written. Allowed: 250,000,000 cells, 2 GB. Give maps.cell, 6.4 m or more.");
  parameters.maps.cell = 6.4;
  const MapGrid grid = map_grid_of(parameters, {});
  EXPECT_EQ(grid.columns, 15625);
  EXPECT_EQ(grid.rows, 15625);
}

}  // namespace
}  // namespace thawslide::sim
