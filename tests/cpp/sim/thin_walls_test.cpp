// A warning is given for walls of the terrain that are thinner than a cell, and not for other ground.
#include "sim/thin_walls.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>

#include "../support/messages.hpp"

namespace thawslide::sim {
namespace {

config::Case case_of(config::TerrainKind kind, int dimension, double cell) {
  config::Case parameters;
  parameters.general.dimension = dimension;
  parameters.terrain.kind = kind;
  parameters.grid.cell = cell;
  parameters.grid.min = {-100.0, -100.0, -100.0};
  parameters.grid.max = {100.0, 100.0, 100.0};
  return parameters;
}

// A dyke at x = 0 with vertical faces.
std::string of_dyke(double width, double height, double cell) {
  config::Site site;
  site.profile.distance = {-200.0, -0.5 * width - 0.01, -0.5 * width, 0.5 * width, 0.5 * width + 0.01, 200.0};
  site.profile.terrain = {0.0, 0.0, height, height, 0.0, 0.0};
  return warning_of_thin_walls(case_of(config::TerrainKind::profile, 2, cell), site);
}

std::string on_raster(const std::function<double(double, double)>& height, double spacing, double cell) {
  auto ground = std::make_shared<Raster>();
  ground->columns = ground->rows = 1 + static_cast<int>(std::lround(240.0 / spacing));
  ground->x = ground->y = -120.0;
  ground->cell_x = ground->cell_y = spacing;
  for (int row = 0; row < ground->rows; ++row) {
    for (int column = 0; column < ground->columns; ++column) {
      ground->values.push_back(height(-120.0 + column * spacing, -120.0 + row * spacing));
    }
  }
  config::Site site;
  site.ground = ground;
  return warning_of_thin_walls(case_of(config::TerrainKind::dem, 3, cell), site);
}

TEST(ThinWalls, OfProfiles) {
  testing_support::expect_in(of_dyke(2.0, 40.0, 5.0),
                             "the terrain has a wall thinner than a cell (5 m), 40 m high. A slide");
  EXPECT_NE(of_dyke(4.5, 6.0, 5.0), "");
  EXPECT_EQ(of_dyke(4.5, 4.9, 5.0), "") << "lower than a cell";
  EXPECT_EQ(of_dyke(5.1, 40.0, 5.0), "") << "a cell thick";
  EXPECT_EQ(of_dyke(2.0, 40.0, 1.9), "");
  config::Site site;  // cliffs and sharp crests are not walls
  site.profile.distance = {-200.0, -50.0, -49.9, 0.0, 60.0, 200.0};
  site.profile.terrain = {0.0, 0.0, 80.0, 150.0, 60.0, 0.0};
  EXPECT_EQ(warning_of_thin_walls(case_of(config::TerrainKind::profile, 2, 5.0), site), "");
}

TEST(ThinWalls, OfRasters) {
  const auto wall = [](double a, double b) {
    return [=](double x, double y) { return std::abs(a * x + b * y) < 1.2 ? 30.0 : 0.1 * x; };
  };
  for (const auto& height : {wall(1.0, 0.0), wall(0.0, 1.0), wall(0.7071, 0.7071), wall(0.7071, -0.7071)}) {
    EXPECT_NE(on_raster(height, 1.0, 6.0), "");
    EXPECT_EQ(on_raster(height, 1.0, 2.0), "");
  }
  EXPECT_EQ(on_raster([](double x, double y) { return -1.1 * std::abs(x - y); }, 1.0, 6.0), "") << "a sharp crest";
  EXPECT_EQ(on_raster([](double x, double) { return x > 3.0 ? 50.0 : 0.0; }, 1.0, 6.0), "") << "a cliff";
  const std::string outside = on_raster([](double x, double) { return x > 110.0 && x < 113.0 ? 50.0 : 0.0; }, 1.0, 6.0);
  EXPECT_EQ(outside, "") << "beyond the domain";
}

}  // namespace
}  // namespace thawslide::sim
