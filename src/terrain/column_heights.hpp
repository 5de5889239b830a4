// Ground below particles on cells that follow it (terrain/following_ground.hpp), from the heights of the columns of
// nodes; and ground at a node. For host and device.
#pragma once

#include <array>
#include <cmath>

#include "base/linear.hpp"
#include "base/portability.hpp"
#include "base/select.hpp"
#include "mpm/body_sizes.hpp"
#include "mpm/scalar_index.hpp"
#include "mpm/section_width.hpp"
#include "mpm/shape.hpp"

namespace thawslide::terrain {

// Ground at a node, computed once. The cells follow the ground: its nodes are those of layer 0.
template <int Dim>
struct GroundAtNode {
  bool candidate = false;      // the node is on the ground or below it: particles that have sunk in reach it
  int substrate = 0;           // below the node (substrates.hpp)
  Vector<double, Dim> normal;  // unit vector from the sliding mass into the ground
  double area = 0;             // of the ground over the node's hat function [m2]; 0 except in layer 0
  double bend = 1;             // chi: 1 on a plane, larger where the ground bends within reach of the node
  double plane = 0;            // of the node, x.n = c.n, times plane_scale [m]; infinite unless the node is a candidate
  double plane_scale = 0;      // factor of both sides: 0 on planes, where the height above the ground is the clearance
  double elevation = 0;        // of the node [m]
};

inline constexpr int column_margin = 8;  // columns beyond the domain
inline constexpr int chunk_edge = 16;    // columns computed together, along each axis

// Columns of nodes of the domain, with a margin, in chunks. Columns in a chunk, and chunks, are ordered x fastest.
template <int Dim>
struct ColumnChunks {
  using Column = std::array<int, Dim - 1>;

  static constexpr int size = Dim == 2 ? chunk_edge : chunk_edge * chunk_edge;

  Column columns{}, chunks{};  // along each axis, including the margins

  struct Place {
    std::size_t chunk = 0, column = 0;  // number of the chunk, and of the column in it
  };
  // Columns beyond the margin have the place of the nearest one.
  [[nodiscard]] THAWSLIDE_HD Place place_of(const Column& column) const {
    Place place;
    for (std::size_t a = Dim - 1; a-- > 0;) {
      const int number = column[a] + column_margin, last = columns[a] - 1;
      const auto along = static_cast<std::size_t>(number < 0 ? 0 : number > last ? last : number);
      place.chunk = place.chunk * static_cast<std::size_t>(chunks[a]) + along / chunk_edge;
      place.column = place.column * chunk_edge + along % chunk_edge;
    }
    return place;
  }
};

// B, and its gradient by the shape functions of momentum and by linear ones.
template <int Dim>
struct GroundBelow {
  double height;
  Vector<double, Dim - 1> slope, linear_slope;
};

// half: half size of a particle, in cells. height(column): of a column of nodes [m]; height.around(lowest, heights),
// if it exists, copies those of the three columns along each axis from the lowest one, x fastest.
template <int Dim, class HeightOf>
THAWSLIDE_HD GroundBelow<Dim> ground_below(const Vector<double, Dim - 1>& point, const mpm::HalfSize<double>& half,
                                           double cell, const ColumnChunks<Dim>& columns, const HeightOf& height) {
  using std::floor;
  using Chunks = ColumnChunks<Dim>;
  typename Chunks::Column lowest{};
  mpm::AxisWeights<double> axis[Dim - 1], linear[Dim - 1];
  for (std::size_t a = 0; a + 1 < Dim; ++a) {
    const double in_cells = point[static_cast<int>(a)] / cell;
    const double node = floor(in_cells + 0.5);
    const double first = -column_margin, last = columns.columns[a] - column_margin;
    lowest[a] = static_cast<int>(max(first, min(node, last))) - 1;  // `first` for a number that is not finite
    axis[a] = mpm::ugimp_weights<double>(in_cells - node, half, 1.0 / cell);
    linear[a] = mpm::linear_weights<double>(in_cells - node, 1.0 / cell);
  }
  GroundBelow<Dim> found;
  found.height = 0.0;
  found.slope.setZero();
  found.linear_slope.setZero();
  [[maybe_unused]] double known[Dim == 2 ? 3 : 9];
  if constexpr (requires { height.around(lowest, known); }) {
    height.around(lowest, known);
  }
  const auto of_column = [&](int k) {
    if constexpr (requires { height.around(lowest, known); }) {
      return known[k];
    } else if constexpr (Dim == 2) {
      return height({lowest[0] + k});
    } else {
      return height({lowest[0] + k % 3, lowest[1] + k / 3});
    }
  };
  if constexpr (Dim == 2) {
    for (int i = 0; i < 3; ++i) {
      const double b = of_column(i);
      found.height += axis[0].weight[i] * b;
      found.slope[0] += axis[0].slope[i] * b;
      found.linear_slope[0] += linear[0].slope[i] * b;
    }
  } else {
    for (int j = 0; j < 3; ++j) {
      double along = 0.0, slope = 0.0, linear_along = 0.0, linear_slope = 0.0;
      for (int i = 0; i < 3; ++i) {
        const double b = of_column(3 * j + i);
        along += axis[0].weight[i] * b;
        slope += axis[0].slope[i] * b;
        linear_along += linear[0].weight[i] * b;
        linear_slope += linear[0].slope[i] * b;
      }
      found.height += axis[1].weight[j] * along;
      found.slope[0] += axis[1].weight[j] * slope;
      found.slope[1] += axis[1].slope[j] * along;
      found.linear_slope[0] += linear[1].weight[j] * linear_slope;
      found.linear_slope[1] += linear[1].slope[j] * linear_along;
    }
  }
  return found;
}

// Ground for a particle of a size, below any horizontal position.
template <int Dim, class HeightOf>
struct GroundAnywhere {
  using Point = Vector<double, Dim - 1>;
  struct Below {
    double height;               // [m]
    Vector<double, Dim> normal;  // into the ground
  };

  ColumnChunks<Dim> columns;
  HeightOf height;
  double half, cell;  // half size of the particle, in cells; [m]
  mpm::WidthView section;

  [[nodiscard]] THAWSLIDE_HD Below below(const Point& point) const {
    const GroundBelow<Dim> ground = ground_below<Dim>(point, half, cell, columns, height);
    Vector<double, Dim> normal;
    normal.template head<Dim - 1>() = ground.slope;
    normal[Dim - 1] = -1.0;
    return {ground.height, normal.normalized()};
  }
  // Of a 2D section, relative.
  [[nodiscard]] THAWSLIDE_HD double width(const Point& point) const { return section.at(point[0]); }
};

// Sets the height above the ground and the slopes of the ground from the position of a particle.
template <int Dim, class HeightOf>
struct LocateAboveGround {
  ColumnChunks<Dim> columns;
  HeightOf height;
  mpm::SizesOfBodies sizes;  // in cells
  double cell;               // [m]

  template <class Particles>
  THAWSLIDE_HD void operator()(Particles& particles, const mpm::ScalarIndex& at) const {
    const std::uint32_t p = at.particle[0];
    Vector<double, Dim - 1> point;
    for (int a = 0; a + 1 < Dim; ++a) {
      point[a] = particles.position(p, a);
    }
    const GroundBelow<Dim> ground = ground_below(point, sizes.of(particles, at), cell, columns, height);
    particles.height_above_ground(p) = particles.position(p, Dim - 1) - ground.height;
    for (int a = 0; a + 1 < Dim; ++a) {
      particles.ground_slope(p, a) = ground.slope[a];
      particles.linear_slope(p, a) = ground.linear_slope[a];
    }
  }
};

}  // namespace thawslide::terrain
