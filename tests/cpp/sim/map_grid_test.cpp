// The grid that maps are gathered on: where its cells lie, and how many there may be.
#include "sim/map_grid.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "base/error.hpp"

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
  const MapGrid grid = map_grid_of(parameters, site);  // the ground's cells reach from 98.5 to 143.5 m, 185 to 245 m
  EXPECT_EQ(grid.x, 101.0);
  EXPECT_EQ(grid.cell_x, 5.0);
  EXPECT_EQ(grid.columns, 11);
  EXPECT_EQ(grid.y, 190.0);
  EXPECT_EQ(grid.rows, 6);
  EXPECT_EQ(grid.crs, "a system");
  parameters.maps.cell = 2.5;
  parameters.grid.min[0] = 98.0;
  const MapGrid asked = map_grid_of(parameters, site);
  EXPECT_EQ(asked.x, 98.5 - 2.5 + 1.25);
  EXPECT_EQ(asked.columns, 22);  // 96 to 151 m
  EXPECT_EQ(asked.cell_y, 2.5);
  EXPECT_EQ(asked.rows, 24);
}

TEST(MapGrid, OfTooManyCellsIsRefused) {
  config::Case parameters;
  parameters.file = "case.toml";
  parameters.grid.max = {1e5, 1e5, 1e3};
  parameters.maps.cell = 0.1;
  try {
    static_cast<void>(map_grid_of(parameters, {}));
    FAIL();
  } catch (const UserError& error) {
    EXPECT_STREQ(error.what(),
                 "case.toml: maps of 1000000 x 1000000 cells of 0.1 x 0.1 m are too many: each would take 8e+03 GB of "
                 "memory while it is written. Allowed: 2.5e+08 cells, 2 GB. Give maps.cell, 6.4 m or more.");
  }
  parameters.maps.cell = 6.4;
  const MapGrid grid = map_grid_of(parameters, {});
  EXPECT_EQ(grid.columns, 15625);
  EXPECT_EQ(grid.rows, 15625);
}

}  // namespace
}  // namespace thawslide::sim
