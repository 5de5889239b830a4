// The thickness of the cells that form the band.
#include "terrain/layer_thickness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "base/raster.hpp"
#include "terrain/height_field.hpp"
#include "terrain/profile_surface.hpp"

namespace thawslide::terrain {
namespace {

// A plane that rises with the given gradient from `left` at x = 0.
std::shared_ptr<const Surface<2>> plane(double gradient, double left) {
  return std::make_shared<ProfileSurface<2>>(Polyline({0.0, 1000.0}, {left, left + 1000.0 * gradient}));
}

using Layer = LayerThickness<2>;

double at(Layer layer, double x) { return layer.at(Layer::Point(x)); }

TEST(LayerThickness, OneCellOnLevelGroundAlongAGridLine) {
  EXPECT_NEAR(at(Layer(plane(0.0, 20.0), 10.0, 5.0, Layer::Filling::lattice), 123.0), 10.0, 1e-12);
}

TEST(LayerThickness, LevelGroundBelowAGridLineAddsTheFractionOfItsCell) {
  EXPECT_NEAR(at(Layer(plane(0.0, 17.0), 10.0, 0.5, Layer::Filling::lattice), 123.0), 13.0, 1e-12);
  // Particles 5 m apart: the one at 17.5 m is above the ground, and its lower edge is at 15 m.
  EXPECT_NEAR(at(Layer(plane(0.0, 17.0), 10.0, 5.0, Layer::Filling::lattice), 123.0), 15.0, 1e-12);
}

// A corner is a candidate if it is less than h (1 + t) above the ground. Cells therefore extend up to h (1 + t (1 + u)
// + w) above it, with the coordinates u and w of the point in its cell: on average over all positions 1.5 h (1 + t)
// vertically.
TEST(LayerThickness, OfSlopesIsThatOfTheirCells) {
  for (const double degrees : {10.0, 20.0, 35.0}) {
    const double gradient = std::tan(degrees * 3.14159265358979 / 180.0);
    Layer layer(plane(gradient, -1.0), 10.0, 5.0, Layer::Filling::lattice);
    double mean = 0.0;
    for (int k = 0; k < 4000; ++k) {
      mean += layer.at(Layer::Point(500.0 + k)) / 4000.0;
    }
    EXPECT_NEAR(mean / (15.0 * (1.0 + gradient) / std::hypot(1.0, gradient)), 1.0, 0.01) << degrees;
  }
}

TEST(LayerThickness, IsConstantAlongASlopeThatRepeatsWithTheGrid) {
  Layer layer(plane(1.0, 3.7), 10.0, 5.0, Layer::Filling::lattice);
  // Ground 3.7 m above a corner: the highest candidate of a column is 30 m above that, and its cell ends at 40 m. The
  // ground is 6.2 and 11.2 m high under the two particles of a column; the centres of the lowest ones are at 7.5 and
  // 12.5 m.
  const double vertical = 40.0 - (5.0 + 10.0) / 2.0;
  for (const double x : {0.0, 77.0, 123.0, 500.0}) {
    EXPECT_NEAR(layer.at(Layer::Point(x)), vertical / std::sqrt(2.0), 1e-9);
  }
  EXPECT_NEAR(layer.largest(Layer::Point(0.0), Layer::Point(500.0)), vertical / std::sqrt(2.0), 1e-9);
}

// A DEM of the same plane has the same layer, along either axis.
TEST(LayerThickness, OfADemIsThatOfTheProfile) {
  constexpr double gradient = 0.6, cell = 10.0, spacing = 5.0;
  Layer along(plane(gradient, 3.0), cell, spacing, Layer::Filling::on_ground);
  for (const int axis : {0, 1}) {
    Raster points;
    points.x = points.y = -200.0;
    points.cell_x = points.cell_y = 10.0;
    points.columns = points.rows = 101;
    for (int row = 0; row < points.rows; ++row) {
      for (int column = 0; column < points.columns; ++column) {
        points.values.push_back(3.0 + gradient * (axis == 0 ? points.x_of(column) : points.y_of(row)));
      }
    }
    LayerThickness<3> layer(std::make_shared<HeightField>(points), cell, spacing,
                            LayerThickness<3>::Filling::on_ground);
    for (const double position : {123.0, 301.7, 477.0}) {
      const Vector<double, 2> there =
          axis == 0 ? Vector<double, 2>(position, 250.0) : Vector<double, 2>(250.0, position);
      EXPECT_NEAR(layer.at(there), at(along, position), 1e-9) << axis;
    }
  }
}

}  // namespace
}  // namespace thawslide::terrain
