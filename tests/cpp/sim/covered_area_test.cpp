// Area covered by a slide: the given outline before it moves, fractions of cells at its edge after it has moved.
#include "sim/maps/covered_area.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <string>

#include "base/raster.hpp"

namespace thawslide::sim {
namespace {

constexpr double least = 0.1;  // m
const MapGrid grid{-140.0, -140.0, 10.0, 10.0, 29, 29, ""};

// A raster of cells of 10 m around the origin, with the mean of a thickness over each cell.
Raster cells_of(int half, const std::function<double(double, double)>& thickness) {
  Raster raster;
  raster.cell_x = raster.cell_y = 10.0;
  raster.x = raster.y = -10.0 * half;
  raster.columns = raster.rows = 2 * half + 1;
  constexpr int parts = 16;
  for (int row = 0; row < raster.rows; ++row) {
    for (int column = 0; column < raster.columns; ++column) {
      double sum = 0.0;
      for (int k = 0; k < parts * parts; ++k) {
        sum += thickness(raster.x_of(column) + 10.0 * ((k % parts + 0.5) / parts - 0.5),
                         raster.y_of(row) + 10.0 * ((k / parts + 0.5) / parts - 0.5));
      }
      raster.values.push_back(sum / (parts * parts));
    }
  }
  return raster;
}

struct Rectangle {
  double length, width, degrees, x, y;  // m, m, from east, centre [m]

  [[nodiscard]] bool contains(double east, double north) const {
    const double angle = degrees * 3.14159265358979323846 / 180.0;
    const double along = std::cos(angle) * (east - x) + std::sin(angle) * (north - y);
    const double across = std::cos(angle) * (north - y) - std::sin(angle) * (east - x);
    return std::abs(along) < 0.5 * length && std::abs(across) < 0.5 * width;
  }
  [[nodiscard]] double area() const { return length * width; }
  [[nodiscard]] config::Polyline2 outline() const {
    const double angle = degrees * 3.14159265358979323846 / 180.0;
    config::Polyline2 ring;
    for (const auto& [a, b] : {std::array{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}}) {
      const double along = 0.5 * length * a, across = 0.5 * width * b;
      ring.push_back({x + std::cos(angle) * along - std::sin(angle) * across,
                      y + std::sin(angle) * along + std::cos(angle) * across});
    }
    return ring;
  }
};

// At least eight cells wide; aligned, oblique and offset from the cell borders.
std::vector<Rectangle> rectangles() {
  std::vector<Rectangle> all;
  for (const auto& [length, width] : {std::array{80.0, 80.0}, {84.0, 87.0}, {150.0, 80.0}}) {
    for (const double degrees : {0.0, 10.0, 22.5, 45.0, 70.0}) {
      for (const double off : {0.0, 2.5, 4.0, 7.3}) {
        all.push_back({length, width, degrees, off, 0.6 * off});
      }
    }
  }
  return all;
}

// Area of a release alone, or with a box.
DrawnArea drawn_area(const config::Release& release, const MapGrid& cells = grid, double taper = 0.0,
                     const std::map<std::string, config::Body>& others = {}) {
  config::Case parameters;
  parameters.maps.arrival_thickness = least;
  parameters.bodies = others;
  parameters.bodies["slide"].shape = config::BodyShape::release;
  parameters.bodies["slide"].taper = taper;
  return {parameters, {{"slide", release}}, cells};
}

double mask_area(const CoveredCells& cells) {
  const Raster mask = cells.mask();
  return mask.cell_x * mask.cell_y * std::accumulate(mask.values.begin(), mask.values.end(), 0.0);
}

double area_of_whole_cells(const Raster& thickness) {
  return 100.0 * static_cast<double>(std::count_if(thickness.values.begin(), thickness.values.end(),
                                                   [](double h) { return h > least; }));
}

TEST(CoveredArea, OfWallsIsExactInAnyDirection) {
  double largest_of_cells = 0.0;
  for (const Rectangle& wall : rectangles()) {
    for (const double height : {0.3, 2.0, 25.0}) {
      const Raster h = cells_of(14, [&](double x, double y) { return wall.contains(x, y) ? height : 0.0; });
      // At the start, and after arrival at a location that was empty.
      for (const Raster& start : {h, h.filled(0.0)}) {
        const CoveredCells covered = covered_cells(h, start, {}, 0, 0, least);
        EXPECT_NEAR(covered.area(), wall.area(), 0.05 * wall.area())
            << wall.length << " x " << wall.width << " m, " << wall.degrees << " degrees, off " << wall.x;
        EXPECT_NEAR(mask_area(covered), covered.area(), 1e-9 * wall.area());
      }
      largest_of_cells = std::max(largest_of_cells, area_of_whole_cells(h) / wall.area());
    }
  }
  EXPECT_GT(largest_of_cells, 1.25) << "whole cells are no measure of the area";
}

TEST(CoveredArea, OfAReleaseAtRestIsThatOfItsOutline) {
  for (const Rectangle& rectangle : rectangles()) {
    // The points of the DEM interpolate the thickness: a ramp, two cells wide, along the outline.
    const Raster points = cells_of(14, [&](double x, double y) { return rectangle.contains(x, y) ? 20.0 : 0.0; });
    Raster h = points;
    for (int row = 1; row + 1 < h.rows; ++row) {
      for (int column = 1; column + 1 < h.columns; ++column) {
        constexpr std::array<double, 3> weights{0.125, 0.75, 0.125};
        double mean = 0.0;
        for (int k = 0; k < 9; ++k) {
          mean += weights[static_cast<std::size_t>(k % 3)] * weights[static_cast<std::size_t>(k / 3)] *
                  points.at(column + k % 3 - 1, row + k / 3 - 1);
        }
        h.values[h.index(column, row)] = mean;
      }
    }
    config::Release release;
    release.thickness = points;
    release.outlines = {rectangle.outline()};
    const CoveredCells covered = covered_cells(h, h, drawn_area(release), 0, 0, least);
    EXPECT_NEAR(covered.area(), rectangle.area(), 0.05 * rectangle.area())
        << rectangle.degrees << " degrees, off " << rectangle.x;
    EXPECT_NEAR(mask_area(covered), covered.area(), 1e-9 * rectangle.area());
    EXPECT_GT(area_of_whole_cells(h), 1.3 * rectangle.area()) << "cells that the ramp reaches";
    // It settles by less than a tenth.
    Raster settled = h;
    std::for_each(settled.values.begin(), settled.values.end(), [](double& value) { value *= 1.05; });
    EXPECT_EQ(covered_cells(settled, h, drawn_area(release), 0, 0, least).area(), covered.area());
  }
}

TEST(CoveredArea, OfARasterReleaseIsThatOfItsCells) {
  const Rectangle rectangle{100.0, 80.0, 0.0, 5.0, 5.0};
  config::Release release;
  release.thickness = cells_of(14, [&](double x, double y) { return rectangle.contains(x, y) ? 20.0 : 0.0; });
  for (const double cell : {10.0, 5.0, 20.0}) {
    const int count = static_cast<int>(280.0 / cell);
    const double first = -145.0 + 0.5 * cell;
    const MapGrid of_cell{first, first, cell, cell, count, count, ""};
    const DrawnArea area = drawn_area(release, of_cell);
    double parts = 0.0;
    for (int row = 0; row < count; ++row) {
      for (int column = 0; column < count; ++column) {
        parts += std::popcount(area.parts(column, row));
      }
    }
    EXPECT_NEAR(parts / parts_of_cell * cell * cell, rectangle.area(), 1e-9 * rectangle.area()) << cell;
  }
}

// Next to the release, where the DEM turns its outline into a ramp, and far from it.
TEST(CoveredArea, OfABoxNextToAReleaseIsExact) {
  const Rectangle rectangle{80.0, 80.0, 0.0, -45.0, 5.0};
  for (const double x : {35.0, 55.0}) {
    const Rectangle box{80.0, 60.0, 0.0, x, 5.0};
    const Raster h = cells_of(14, [&](double east, double north) {
      return rectangle.contains(east, north) || box.contains(east, north) ? 20.0 : 0.0;
    });
    config::Release release;
    release.thickness =
        cells_of(14, [&](double east, double north) { return rectangle.contains(east, north) ? 20.0 : 0.0; });
    release.outlines = {rectangle.outline()};
    config::Body body;
    body.min = {x - 40.0, -25.0, 0.0};
    body.max = {x + 40.0, 35.0, 20.0};
    const DrawnArea area = drawn_area(release, grid, 0.0, {{"box", body}});
    EXPECT_NEAR(covered_cells(h, h, area, 0, 0, least).area(), rectangle.area() + box.area(), 1e-9) << x;
    EXPECT_NEAR(covered_cells(h, h, drawn_area(release), 0, 0, least).area(), rectangle.area(), 1e-9);
  }
}

TEST(CoveredArea, OfATaperedReleaseExtendsToTheMinimumThickness) {
  const Rectangle rectangle{80.0, 80.0, 0.0, 5.0, 5.0};
  constexpr double taper = 40.0;  // m, half of it beyond the outline; the ramp is that of gis::tapered
  const auto ramp = [](double from_middle) {
    const double fraction = std::clamp(0.5 - (std::abs(from_middle) - 40.0) / taper, 0.0, 1.0),
                 turn = 2.0 * std::numbers::pi;
    return fraction - std::sin(turn * fraction) / turn;
  };
  config::Release release;
  release.thickness =
      cells_of(14, [&](double x, double y) { return 20.0 * ramp(x - rectangle.x) * ramp(y - rectangle.y); });
  release.outlines = {rectangle.outline()};
  const Raster h = cells_of(14, [&](double x, double y) { return bilinear(release.thickness, x, y, Missing::zero); });
  // 20 m times the ramp is 0.1 m at 3.7 m from the end of the taper; points 10 m apart extend it by up to 5 m.
  const double area = covered_cells(h, h, drawn_area(release, grid, taper), 0, 0, least).area();
  EXPECT_GT(area, 0.97 * 112.6 * 112.6);
  EXPECT_LT(area, 122.6 * 122.6);
  // A taper at most two cells wide changes no point.
  EXPECT_NEAR(covered_cells(h, h, drawn_area(release, grid, 20.0), 0, 0, least).area(), rectangle.area(), 1e-9);
}

TEST(CoveredArea, GrowsByTheReachedArea) {
  const Rectangle rectangle{80.0, 80.0, 0.0, 5.0, 5.0}, reached{200.0, 80.0, 0.0, 5.0, 5.0};
  const auto slab = [&](const Rectangle& place) {
    return cells_of(14, [&](double x, double y) { return place.contains(x, y) ? 10.0 : 0.0; });
  };
  config::Release release;
  release.thickness = slab(rectangle);
  release.outlines = {rectangle.outline()};
  const DrawnArea area = drawn_area(release);
  EXPECT_NEAR(covered_cells(slab(reached), slab(rectangle), area, 0, 0, least).area(), reached.area(), 1e-9);
  EXPECT_EQ(covered_cells(slab(rectangle).filled(0.0), slab(rectangle), area, 0, 0, least).area(), 0.0)
      << "the slide has left";
}

TEST(CoveredArea, OfASlideThatThinsOutEvenlyCountsAllCells) {
  // A cone of 1 in 10: each cell at its edge is thicker than the minimum.
  const Raster cone = cells_of(14, [](double x, double y) { return std::max(0.0, 10.0 - 0.1 * std::hypot(x, y)); });
  const double area = covered_cells(cone, cone.filled(0.0), {}, 0, 0, least).area();
  const double exact = 3.14159265358979323846 * 99.0 * 99.0;  // at least 0.1 m thick
  EXPECT_GT(area, 0.97 * exact);
  EXPECT_LT(area, 1.05 * exact);
  EXPECT_EQ(covered_cells(cone.filled(std::nan("")), cone.filled(0.0), {}, 0, 0, least).area(), 0.0);
}

// A thin area within the slide is not an edge.
TEST(CoveredArea, CellsWithinTheSlideCountCompletely) {
  Raster h = cells_of(6, [](double, double) { return 10.0; });
  h.values[h.index(6, 6)] = 0.5;
  EXPECT_EQ(covered_fraction(h, 6, 6, least), 1.0);
  h.values[h.index(7, 6)] = 0.0;
  EXPECT_NEAR(covered_fraction(h, 6, 6, least), 0.05, 1e-12);
  EXPECT_EQ(covered_fraction(h, 7, 6, least), 0.0);
}

}  // namespace
}  // namespace thawslide::sim
