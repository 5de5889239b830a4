// Nodal quantities of the triangulated surface of a DEM: area, space, normal and distance.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "../support/record.hpp"
#include "../support/small_terrain.hpp"
#include "terrain/height_field.hpp"
#include "terrain/polyline.hpp"

namespace thawslide::terrain {
namespace {

using namespace testing_support;

// Sum over all nodes above a grid position, from a level below the ground upwards.
struct Column {
  double area = 0.0, space = 0.0;
};
std::vector<Column> columns_at(const HeightField& ground, const Position& lowest, double cell, int blocks) {
  std::vector<Column> columns(edge * edge);
  for (int b = 0; b < blocks; ++b) {
    const auto nodes = block_at(ground, lowest + Position(0.0, 0.0, b * edge * cell), cell);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      columns[k % columns.size()].area += nodes[k].area;
      columns[k % columns.size()].space += nodes[k].space;
    }
  }
  return columns;
}

// The shape functions of a column of nodes sum to 1 up to the highest node and decrease to 0 within a cell.
TEST(HeightField, OfAPlaneIsExact) {
  constexpr double h = 3.3;
  for (const double tilt : {0.0, 0.2, 0.7, 1.2}) {
    for (const double azimuth : {0.0, 0.4, 1.9, 3.9}) {
      const Place slope = std::tan(tilt) * Place(std::cos(azimuth), std::sin(azimuth));
      const auto plane = [&](double x, double y) { return 40.0 + slope[0] * (x - 21.0) + slope[1] * (y - 17.0); };
      const HeightField ground(raster(-12.0, -9.0, 5.0, 13, 12, plane));
      const Position into = Position(slope[0], slope[1], -1.0).normalized();
      EXPECT_NEAR(ground.height({10.3, 14.2}), plane(10.3, 14.2), 1e-12);
      EXPECT_NEAR((ground.gradient({10.3, 14.2}, 0.0) - slope).norm(), 0.0, 1e-12);
      const Position lowest(15.1, 11.7, 40.0 - 24.0 * h);
      const auto columns = columns_at(ground, lowest, h, 12);
      const double top = lowest[2] + (12 * edge - 1) * h;
      for (int j = 0; j < edge; ++j) {
        for (int i = 0; i < edge; ++i) {
          const Column& column = columns[static_cast<std::size_t>(i + edge * j)];
          EXPECT_NEAR(column.area / (h * h / std::cos(tilt)), 1.0, 1e-12);
          const double space = h * h * (top + 0.5 * h - plane(lowest[0] + i * h, lowest[1] + j * h));
          EXPECT_NEAR(column.space / space, 1.0, 1e-12);
        }
      }
      const Position middle(15.1, 11.7, plane(20.0, 16.0) - 1.4 * h);
      const auto nodes = block_at(ground, middle, h);
      for (int k = 0; k < edge; ++k) {
        const Node& node = nodes[node_number(1, 2, k)];
        const Position place = middle + h * Position(1, 2, k);
        const double distance = (place[2] - plane(place[0], place[1])) * std::cos(tilt);
        EXPECT_NEAR(node.distance, distance, 1e-12);
        EXPECT_NEAR((node.normal - into).norm(), 0.0, 1e-9);
        EXPECT_NEAR(node.bend, 1.0, 1e-12);
        if (node.candidate) {
          EXPECT_NEAR(node.plane, into.dot(Position(15.0, 10.0, plane(15.0, 10.0))), 1e-9);
        }
        const double highest = plane(place[0], place[1]) + h * slope.lpNorm<1>();
        EXPECT_EQ(node.candidate, highest > place[2] - h);
      }
    }
  }
}

TEST(HeightField, UniformAlongYIsThePolyline) {
  constexpr double h = 4.1;
  const std::vector<double> heights{100.0, 22.0, 21.0, 20.0, 14.0, 15.5, 9.0, 3.0, 4.0, 4.0, 1.0};
  std::vector<double> x;
  for (std::size_t k = 0; k < heights.size(); ++k) {
    x.push_back(-31.0 + 7.0 * static_cast<double>(k));
  }
  const Polyline line(x, heights);
  const HeightField ground(raster(-31.0, -20.0, 7.0, 11, 9, [&](double u, double) { return line.height(u); }));
  for (double z = -6.0; z < 24.0; z += edge * h) {
    const Position lowest(0.3, 2.2, z);
    const auto nodes = block_at(ground, lowest, h);
    for (int k = 0; k < edge * edge * edge; ++k) {
      const Position place = lowest + h * Position(k % edge, k / edge % edge, k / edge / edge);
      const Node& node = nodes[static_cast<std::size_t>(k)];
      const auto fraction = line.linear_fraction(place[0], place[2], h);
      EXPECT_NEAR(node.area, h * fraction.length, 1e-11);
      EXPECT_NEAR(node.space, h * fraction.above, 1e-11);
      EXPECT_EQ(node.candidate, line.highest(place[0] - h, place[0] + h) > place[2] - h * (1.0 - 1e-9));
      const auto nearest = line.nearest(place[0], place[2]);
      EXPECT_NEAR(node.distance, std::clamp(nearest.distance, -4.0 * h, 4.0 * h), 1e-12);
      if (node.area == 0.0 && std::abs(nearest.distance) < 4.0 * h) {
        EXPECT_NEAR((node.normal - Position(nearest.normal[0], 0.0, nearest.normal[1])).norm(), 0.0, 1e-9);
      }
      if (node.area > 1e-9 * h * h) {
        const double resultant = fraction.resultant.norm();
        EXPECT_NEAR(node.bend, fraction.length / resultant, 1e-9);
        const Vector<double, 2> normal = fraction.resultant / resultant;
        EXPECT_NEAR((node.normal - Position(normal[0], 0.0, normal[1])).norm(), 0.0, 1e-9);
        const Vector<double, 2> centre = Vector<double, 2>(place[0], place[2]) + fraction.moment / fraction.length;
        EXPECT_NEAR(node.plane, normal.dot(centre), 1e-9 * h);
      }
    }
  }
}

// Values at the centres of parts^2 small triangles, for each triangle.
Node by_quadrature(const Raster& points, const Position& position, double cell, int parts) {
  Node node;
  node.normal.setZero();
  Position moment = Position::Zero();  // in cells
  const auto linear = [](double q) { return std::max(0.0, 1.0 - std::abs(q)); };
  const auto above = [](double q) {
    q = std::clamp(q, -1.0, 1.0);
    return q > 0.0 ? 0.5 * (1.0 - q) * (1.0 - q) : 1.0 - 0.5 * (1.0 + q) * (1.0 + q);
  };
  for (const auto& [first, second, third] : triangles(points)) {
    const Position a = first, b = second, c = third;  // clang 14 cannot capture structured bindings
    const Position across = 0.5 * (b - a).cross(c - a) / (parts * parts);
    const auto add = [&](double i, double j) {
      const Position q = (a + i / parts * (b - a) + j / parts * (c - a) - position) / cell;
      const double plan = linear(q[0]) * linear(q[1]);
      node.area += across.norm() * plan * linear(q[2]);
      node.space += across[2] * plan * cell * above(q[2]);
      node.normal -= across * plan * linear(q[2]);
      moment += across.norm() * plan * linear(q[2]) * q;
    };
    for (int j = 0; j < parts; ++j) {
      for (int i = 0; i + j < parts; ++i) {
        add(i + 1.0 / 3.0, j + 1.0 / 3.0);
        if (i + j + 1 < parts) {
          add(i + 2.0 / 3.0, j + 2.0 / 3.0);
        }
      }
    }
  }
  node.bend = node.area / node.normal.norm();
  node.normal.normalize();
  node.plane = node.normal.dot(position + cell / node.area * moment);
  return node;
}

TEST(HeightField, OfRoughGroundIsTheIntegralOfTheShapeFunction) {
  Raster points = rough_raster();
  points.cell_y = 6.0;
  const HeightField ground(points);
  for (const double h : {3.3, 11.0}) {
    for (const Position& position : {Position(13.0, 21.2, 7.0), Position(22.4, 9.1, 3.0), Position(40.0, 30.0, 10.0)}) {
      const Node node = node_at(ground, position, h);
      const Node expected = by_quadrature(points, position, h, 60);
      EXPECT_NEAR(node.area, expected.area, 1e-4 * h * h);
      EXPECT_NEAR(node.space, expected.space, 1e-4 * h * h * h);
      EXPECT_NEAR((node.normal - expected.normal).norm(), 0.0, 1e-4);
      EXPECT_NEAR(node.bend, expected.bend, 1e-4 * expected.bend);
      EXPECT_NEAR(node.area * (node.plane - expected.plane), 0.0, 1e-4 * h * h * h);
    }
  }
}

TEST(HeightField, NumbersBlocksFromTheLowerCorner) {
  const HeightField ground(rough_raster());
  std::vector<Node> numbered(edge * edge * edge);
  ground.at_block({4, 2, -1}, 3.0, edge, numbered.data());
  const auto placed = block_at(ground, {12.0, 6.0, -3.0}, 3.0);
  for (std::size_t k = 0; k < placed.size(); ++k) {
    EXPECT_EQ(numbered[k].area, placed[k].area);
    EXPECT_EQ(numbered[k].space, placed[k].space);
    EXPECT_EQ(numbered[k].distance, placed[k].distance);
    EXPECT_EQ(numbered[k].normal, placed[k].normal);
  }
}

TEST(HeightField, GivesTheSameNodeInEveryBlock) {
  const HeightField ground(rough_raster());
  const Position position(13.0, 21.2, 7.0);
  const Node node = node_at(ground, position, 3.3);
  for (const auto& [i, j, k] : {std::array{0, 0, 0}, std::array{3, 3, 3}, std::array{3, 0, 2}}) {
    const Node other = node_at(ground, position, 3.3, i, j, k);
    EXPECT_NEAR(other.area, node.area, 1e-12);
    EXPECT_NEAR(other.space, node.space, 1e-12);
    EXPECT_NEAR(other.distance, node.distance, 1e-12);
    EXPECT_NEAR((other.normal - node.normal).norm(), 0.0, 1e-12);
    EXPECT_EQ(other.candidate, node.candidate);
  }
}

// Over a patch of blocks the shape functions sum to 1, and decrease to 0 within the cells around it. If the lines of
// the terrain model are grid lines, that sum is a polynomial over each triangle.
TEST(HeightField, FractionsSumToTheSurfaceAndToTheSpaceAboveIt) {
  constexpr double h = 10.0;
  constexpr int blocks = 2;
  const Raster points = rough_raster();
  const HeightField ground(points);
  const Position lowest(-10.0, -5.0, -5.0);
  double area = 0.0, space = 0.0;
  for (int b = 0; b < blocks; ++b) {
    for (const Column& column : columns_at(ground, lowest + Position(b * edge * h, 0.0, 0.0), h, 1)) {
      area += column.area;
      space += column.space;
    }
  }
  const Position highest = lowest + h * Position(blocks * edge - 1, edge - 1, edge - 1);
  const auto weight = [&](const Position& place) {
    double product = 1.0;
    for (int a = 0; a < 2; ++a) {
      product *= std::max(0.0, std::min({1.0, 1.0 + (place[a] - lowest[a]) / h, 1.0 + (highest[a] - place[a]) / h}));
    }
    return product;
  };
  double expected_area = 0.0, expected_space = 0.0;
  for (const auto& [a, b, c] : triangles(points)) {
    const Position across = 0.5 * (b - a).cross(c - a);
    const auto add = [&](double fraction, const Position& place) {
      expected_area += fraction * across.norm() * weight(place);
      expected_space += fraction * across[2] * weight(place) * (highest[2] + 0.5 * h - place[2]);
    };
    // Exact up to the third degree.
    add(-27.0 / 48.0, (a + b + c) / 3.0);
    for (const Position* corner : {&a, &b, &c}) {
      add(25.0 / 48.0, 0.2 * (a + b + c) + 0.4 * *corner);
    }
  }
  EXPECT_NEAR(area / expected_area, 1.0, 1e-12);
  EXPECT_NEAR(space / expected_space, 1.0, 1e-12);
}

// By the divergence theorem, the integral of S n dA equals that of the gradient of S over the space above the ground,
// which is the change of the node's open space when the node moves in the opposite direction.
TEST(HeightField, NormalIsTheDirectionOfDecreasingOpenSpace) {
  const HeightField ground(rough_raster());
  constexpr double h = 6.0, step = 1e-4;
  for (const Position& position : {Position(13.0, 21.2, 7.0), Position(22.4, 9.1, 3.0), Position(40.0, 30.0, 10.0)}) {
    Position shrinks;
    for (int a = 0; a < 3; ++a) {
      const Position move = step * Position::Unit(a);
      shrinks[a] = node_at(ground, position - move, h).space - node_at(ground, position + move, h).space;
    }
    const Node node = node_at(ground, position, h);
    EXPECT_LT(shrinks.norm() / (2.0 * step), node.area);
    EXPECT_NEAR((node.normal - shrinks.normalized()).norm(), 0.0, 1e-6);
  }
}

TEST(HeightField, OfMirroredAndTurnedPointsIsMirroredAndTurned) {
  Raster points = rough_raster();
  points.x = points.y = -50.0;
  points.columns = points.rows = 17;
  points.values.resize(17 * 17);
  Raster mirrored = points, turned = points;
  for (int row = 0; row < 17; ++row) {
    for (int column = 0; column < 17; ++column) {
      mirrored.values[mirrored.index(16 - column, row)] = points.at(column, row);
      turned.values[turned.index(16 - row, column)] = points.at(column, row);
    }
  }
  points.x = points.y = mirrored.x = mirrored.y = turned.x = turned.y = -40.0;
  const HeightField ground(points), mirror(mirrored), turn(turned);
  constexpr double h = 7.0;
  const auto expect_same = [](const Node& node, const Node& other, const Position& normal) {
    EXPECT_EQ(node.candidate, other.candidate);
    EXPECT_NEAR(node.area, other.area, 1e-13 * h * h);
    EXPECT_NEAR(node.space, other.space, 1e-13 * h * h * h);
    EXPECT_NEAR(node.distance, other.distance, 1e-13 * 40.0);
    EXPECT_NEAR((other.normal - normal).norm(), 0.0, 1e-12);
  };
  const Position place(4.3, -11.1, 6.0);
  const auto nodes = block_at(ground, place, h);
  const auto in_mirror = block_at(mirror, {-place[0] - 3 * h, place[1], place[2]}, h);
  const auto after_turn = block_at(turn, {-place[1] - 3 * h, place[0], place[2]}, h);
  for (int k = 0; k < edge; ++k) {
    for (int j = 0; j < edge; ++j) {
      for (int i = 0; i < edge; ++i) {
        const Node& node = nodes[node_number(i, j, k)];
        const Position& normal = node.normal;
        expect_same(node, in_mirror[node_number(3 - i, j, k)], {-normal[0], normal[1], normal[2]});
        expect_same(node, after_turn[node_number(3 - j, i, k)], {-normal[1], normal[0], normal[2]});
      }
    }
  }
  EXPECT_NEAR(ground.height({4.3, 7.7}), mirror.height({-4.3, 7.7}), 1e-13);
  EXPECT_NEAR(ground.height({4.3, 7.7}), turn.height({-7.7, 4.3}), 1e-13);
}

// Compared with a model of the same smooth surface with points 0.625 m apart, and with the surface itself.
TEST(HeightField, ErrorsFallWithTheSquareOfTheSpacing) {
  const auto surface = [](double x, double y) {
    return 60.0 + 25.0 * std::cos(0.021 * x + 0.3) * std::cos(0.017 * y) + 6.0 * std::cos(0.04 * y - 0.02 * x);
  };
  constexpr double h = 20.0;
  const auto ground = [&](double spacing) {
    const int count = static_cast<int>(240.0 / spacing) + 1;
    return HeightField(raster(0.0, 0.0, spacing, count, count, surface));
  };
  const auto nodes_of = [&](const HeightField& of) {
    std::vector<Node> nodes;
    for (const double z : {-3.0, 77.0}) {
      const auto more = block_at(of, {93.0, 71.0, z}, h);
      nodes.insert(nodes.end(), more.begin(), more.end());
    }
    return nodes;
  };
  verification::Record record("DEMs of a smooth surface",
                              "Hills of 25 m and 6 m are DEMs with points 20 m, 10 m and 5 m apart. The test evaluates "
                              "the ground's area at nodes of cells of 20 m, and its height.",
                              "a model of the same surface with points 0.625 m apart; of heights, the surface itself",
                              "linear interpolation errs by the square of the distance of points");
  const auto reference = nodes_of(ground(0.625));
  const std::vector<double> spacings{20.0, 10.0, 5.0};
  const std::vector<std::string> quantities{"rms error of the area at nodes [m2]",
                                            "rms error of the space at nodes [m3]", "rms error of the normal at nodes",
                                            "rms error of the height [m]"};
  std::vector<std::vector<double>> errors(quantities.size());
  for (const double spacing : spacings) {
    const HeightField of = ground(spacing);
    const auto nodes = nodes_of(of);
    std::array<std::vector<double>, 4> differences;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      differences[0].push_back(nodes[k].area - reference[k].area);
      differences[1].push_back(nodes[k].space - reference[k].space);
      if (reference[k].area > 0.1 * h * h) {
        differences[2].push_back((nodes[k].normal - reference[k].normal).norm());
      }
    }
    for (double x = 40.0; x < 200.0; x += 1.37) {
      differences[3].push_back(of.height({x, 220.0 - x}) - surface(x, 220.0 - x));
    }
    for (std::size_t quantity = 0; quantity < differences.size(); ++quantity) {
      errors[quantity].push_back(verification::root_mean_square(differences[quantity]));
    }
  }
  for (std::size_t quantity = 0; quantity < quantities.size(); ++quantity) {
    const auto& found = errors[quantity];
    EXPECT_NEAR(std::log2(found[0] / found[1]), 2.0, 0.2) << quantities[quantity];
    record.expect_order("distance of points [m]", spacings, quantities[quantity], found, 2.0, 0.2);
  }
}

}  // namespace
}  // namespace thawslide::terrain
