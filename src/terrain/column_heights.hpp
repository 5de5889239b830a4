// Ground below particles on cells that follow it (terrain/following_ground.hpp), from the heights of the columns of
// nodes; and ground at a node. For host and device.
#pragma once

#include <array>
#include <cmath>
#include <type_traits>

#include "base/linear.hpp"
#include "base/portability.hpp"
#include "base/select.hpp"
#include "mpm/body_sizes.hpp"
#include "mpm/kernel.hpp"
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
template <int Dim, class Value = double>
struct GroundBelow {
  Value height;
  Vector<Value, Dim - 1> slope, linear_slope;
};

// half: half size of a particle, in cells. height(column): of a column of nodes [m]; for a batch, height.around(lowest,
// heights) sets those of the three columns along each axis from the lowest one, x fastest.
template <int Dim, class Value, class HeightOf>
THAWSLIDE_HD GroundBelow<Dim, Value> ground_below(const Vector<Value, Dim - 1>& point, const mpm::HalfSize<Value>& half,
                                                  double cell, const ColumnChunks<Dim>& columns,
                                                  const HeightOf& height) {
  using std::floor;
  constexpr bool is_scalar = std::is_same_v<Value, double>;
  std::array<Value, Dim - 1> lowest;
  mpm::AxisWeights<Value> axis[Dim - 1], linear[Dim - 1];
  for (std::size_t a = 0; a + 1 < Dim; ++a) {
    const Value in_cells = point[static_cast<int>(a)] / cell;
    const Value node = floor(in_cells + 0.5);
    const Value first = -static_cast<double>(column_margin),
                last = static_cast<double>(columns.columns[a] - column_margin);
    lowest[a] = max(first, min(node, last)) - 1.0;  // `first` for a number that is not finite
    axis[a] = mpm::ugimp_weights<Value>(in_cells - node, half, 1.0 / cell);
    linear[a] = mpm::linear_weights<Value>(in_cells - node, 1.0 / cell);
  }
  [[maybe_unused]] std::array<Value, Dim == 2 ? 3 : 9> known;
  if constexpr (!is_scalar) {
    height.around(lowest, known);
  }
  const auto of_column = [&](int k) -> Value {
    if constexpr (!is_scalar) {
      return known[static_cast<std::size_t>(k)];
    } else if constexpr (Dim == 2) {
      return height({static_cast<int>(lowest[0]) + k});
    } else {
      return height({static_cast<int>(lowest[0]) + k % 3, static_cast<int>(lowest[1]) + k / 3});
    }
  };
  GroundBelow<Dim, Value> found{Value(0.0), Vector<Value, Dim - 1>::Zero(), Vector<Value, Dim - 1>::Zero()};
  if constexpr (Dim == 2) {
    for (int i = 0; i < 3; ++i) {
      const Value b = of_column(i);
      found.height += axis[0].weight[i] * b;
      found.slope[0] += axis[0].slope[i] * b;
      found.linear_slope[0] += linear[0].slope[i] * b;
    }
  } else {
    for (int j = 0; j < 3; ++j) {
      Value along = 0.0, slope = 0.0, linear_along = 0.0, linear_slope = 0.0;
      for (int i = 0; i < 3; ++i) {
        const Value b = of_column(3 * j + i);
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
    const GroundBelow<Dim> ground = ground_below<Dim, double>(point, half, cell, columns, height);
    Vector<double, Dim> normal;
    normal.template head<Dim - 1>() = ground.slope;
    normal[Dim - 1] = -1.0;
    return {ground.height, normal.normalized()};
  }
  // Of a 2D section, relative.
  [[nodiscard]] THAWSLIDE_HD double width(const Point& point) const { return section.at(point[0]); }
};

// Kernel that sets the height above the ground and the slopes of the ground from the positions of particles.
template <int Dim, class HeightOf>
struct LocateAboveGround {
  using Reads = mpm::RecordList<>;
  using Adds = mpm::RecordList<>;
  using Totals = mpm::NoTotals;

  ColumnChunks<Dim> columns;
  HeightOf height;
  mpm::SizesOfBodies sizes;  // in cells
  double cell;               // [m]

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD void operator()(Particles& particles, const At& at, const Seen& /*seen*/, Scatter& /*added*/,
                               Totals& /*totals*/) const {
    using Value = typename At::Value;
    Vector<Value, Dim - 1> point;
    for (int a = 0; a + 1 < Dim; ++a) {
      point[a] = particles.position.load(at, a);
    }
    const auto ground = ground_below<Dim, Value>(point, sizes.of(particles, at), cell, columns, height);
    particles.height_above_ground.store(at, particles.position.load(at, Dim - 1) - ground.height);
    for (int a = 0; a + 1 < Dim; ++a) {
      particles.ground_slope.store(at, ground.slope[a], a);
      particles.linear_slope.store(at, ground.linear_slope[a], a);
    }
  }
};

}  // namespace thawslide::terrain
