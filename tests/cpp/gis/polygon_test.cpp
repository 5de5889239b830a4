// Areas: union, fractions of cells, and areas of a mask.
#include <numbers>
#include <numeric>
#include <random>

#include "gis/polygons.hpp"
#include "map_files.hpp"

namespace thawslide::gis {
namespace {

using namespace map_files;

Polygon box(double min_x, double min_y, double max_x, double max_y) {
  return {{{min_x, min_y}, {max_x, min_y}, {max_x, max_y}, {min_x, max_y}, {min_x, min_y}}, {}};
}

double sum_of(const Raster& raster) { return std::accumulate(raster.values.begin(), raster.values.end(), 0.0); }

TEST(PolygonTest, FractionsOfABoxFollowFromItsSides) {
  const Raster layout = raster_of([](double, double) { return 0.0; }, 0.0, 0.0, 10.0, 5, 4);
  const Raster fraction = coverage_of({box(-5.0, 2.5, 25.0, 25.0)}, layout);
  const std::vector<double> rows{0.25, 1.0, 1.0, 0.0};  // cells begin at -5, 5, 15, 25
  for_points(fraction, [&](int column, int row) {
    EXPECT_EQ(fraction.at(column, row), column < 3 ? rows[static_cast<std::size_t>(row)] : 0.0) << column << " " << row;
  });
}

// A star with a hole, far from the origin, on cells that are not square.
TEST(PolygonTest, FractionsSumToTheArea) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> number(0.0, 1.0);
  for (int k = 0; k < 20; ++k) {
    Polygon star;
    const double centre_x = 412345.678, centre_y = 301234.567;
    const int corners = 7 + 40 * k;
    for (int c = 0; c < corners; ++c) {
      const double angle = 2.0 * std::numbers::pi * (c + 0.8 * number(random)) / corners;
      const double radius = 60.0 + 100.0 * number(random);
      star.outline.push_back({centre_x + radius * std::cos(angle), centre_y + radius * std::sin(angle)});
    }
    star.outline.push_back(star.outline.front());
    star.holes.push_back(box(centre_x - 20.3, centre_y - 11.1, centre_x + 15.2, centre_y + 22.2).outline);
    if (k % 2 == 0) {
      std::reverse(star.outline.begin(), star.outline.end());  // rings in files may have either orientation
    }
    Raster layout = raster_of([](double, double) { return 0.0; }, centre_x - 203.0, centre_y - 201.0, 4.9977, 83, 1);
    layout.cell_y = 7.25;
    layout.rows = 57;
    const Raster fraction = coverage_of({star}, layout);
    const double area = area_of({star});
    EXPECT_NEAR(sum_of(fraction) * layout.cell_x * layout.cell_y, area, 1e-9 * area) << corners;
    EXPECT_GE(*std::min_element(fraction.values.begin(), fraction.values.end()), 0.0);
    EXPECT_LE(*std::max_element(fraction.values.begin(), fraction.values.end()), 1.0);
  }
}

TEST(PolygonTest, FractionOfATriangleInOneCell) {
  const Raster layout = raster_of([](double, double) { return 0.0; }, 0.0, 0.0, 1.0, 3, 3);
  const Polygon triangle{{{0.6, 0.6}, {1.4, 0.6}, {0.6, 1.4}, {0.6, 0.6}}, {}};
  const Raster fraction = coverage_of({triangle}, layout);
  EXPECT_NEAR(fraction.at(1, 1), 0.32, 1e-15);
  EXPECT_NEAR(sum_of(fraction), 0.32, 1e-15);
}

TEST(PolygonTest, AreasOfAMaskCoverItsCells) {
  // A ring about one empty cell, and a cell that touches it at a corner only.
  Raster mask = raster_of([](double, double) { return 0.0; }, 100.0, 200.0, 2.0, 5, 4);
  set_points(mask, 0, 0, 3, 3, 0.5);
  mask.values[mask.index(1, 1)] = missing;
  mask.values[mask.index(3, 3)] = 2.0;
  const Polygons areas = areas_of_mask(mask);
  ASSERT_EQ(areas.size(), 2U);
  EXPECT_NEAR(area_of(areas), 9.0 * 4.0, 1e-9);
  const Rectangle extent = extent_of(areas);
  EXPECT_EQ((std::array{extent.min_x, extent.max_x, extent.min_y, extent.max_y}),
            (std::array{99.0, 107.0, 199.0, 207.0}));
  // Polygons made from cells cover these cells.
  const Raster fraction = coverage_of(areas, mask);
  for (std::size_t k = 0; k < mask.values.size(); ++k) {
    EXPECT_EQ(fraction.values[k], mask.values[k] > 0.0 ? 1.0 : 0.0);
  }
}

}  // namespace
}  // namespace thawslide::gis
