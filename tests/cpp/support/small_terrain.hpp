// Ground from small DEMs, and its data at the nodes of a block.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "terrain/height_field.hpp"

namespace thawslide::testing_support {

using Place = Vector<double, 2>;
using Position = Vector<double, 3>;
using Node = terrain::GroundAtNode<3>;

constexpr int edge = 4;  // nodes per block, along each axis
constexpr double no_data = std::numeric_limits<double>::quiet_NaN();

inline Raster raster(double x, double y, double cell, int columns, int rows,
                     const std::function<double(double, double)>& height) {
  Raster made{
      .x = x, .y = y, .cell_x = cell, .cell_y = cell, .columns = columns, .rows = rows, .values = {}, .crs = {}};
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      made.values.push_back(height(made.x_of(column), made.y_of(row)));
    }
  }
  return made;
}

inline Raster rough_raster() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> height(0.0, 12.0);
  return raster(-20.0, -15.0, 5.0, 21, 17, [&](double, double) { return height(random); });
}

inline std::vector<Node> block_at(const terrain::HeightField& ground, const Position& lowest, double cell) {
  std::vector<Node> nodes(edge * edge * edge);
  ground.at_nodes_from(lowest, cell, edge, nodes.data());
  return nodes;
}

inline std::size_t node_number(int i, int j, int k) { return static_cast<std::size_t>(i + edge * (j + edge * k)); }

// Ground at one node, wherever it is in the block.
inline Node node_at(const terrain::HeightField& ground, const Position& position, double cell, int i = 1, int j = 2,
                    int k = 1) {
  return block_at(ground, position - cell * Position(i, j, k), cell)[node_number(i, j, k)];
}

// Triangles of a DEM, constructed independently.
inline std::vector<std::array<Position, 3>> triangles(const Raster& points) {
  std::vector<std::array<Position, 3>> all;
  for (int row = 0; row + 1 < points.rows; ++row) {
    for (int column = 0; column + 1 < points.columns; ++column) {
      const auto point = [&](int i, int j) {
        return Position(points.x_of(column + i), points.y_of(row + j), points.at(column + i, row + j));
      };
      const std::array<Position, 4> ring{point(0, 0), point(1, 0), point(1, 1), point(0, 1)};
      const Position centre = 0.25 * (ring[0] + ring[1] + ring[2] + ring[3]);
      for (std::size_t k = 0; k < 4; ++k) {
        all.push_back({ring[k], ring[(k + 1) % 4], centre});
      }
    }
  }
  return all;
}

}  // namespace thawslide::testing_support
