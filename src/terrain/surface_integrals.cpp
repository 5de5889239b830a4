#include "terrain/surface_integrals.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "terrain/triangle_rule.hpp"

namespace thawslide::terrain {

namespace {

// In cells: parts this little beyond a grid plane are not cut off, because the cut would consist of round-off.
constexpr double sliver = 1e-12;
// In areas of a cell's face: a smaller area does not define a direction.
constexpr double least_area = 1e-12;

// Calls slice(k, part) for the parts of a polygon between k and k + 1 along an axis; k is -1 for everything below 0 and
// `count` for everything above `count`.
template <class Slice>
void for_slices(const ConvexPolygon& polygon, int axis, int count, const Slice& slice) {
  const auto [least, greatest] = polygon.extent(axis);
  const auto limited = [&](double k) { return static_cast<int>(std::max(-1.0, std::min(k, double(count)))); };
  const int first = limited(std::floor(least + sliver));
  const int last = std::max(first, limited(std::ceil(greatest - sliver) - 1.0));
  if (first == last) {
    slice(first, polygon);
    return;
  }
  ConvexPolygon rest = polygon, part, above;
  for (int k = first; k < last; ++k) {
    rest.split(axis, k + 1.0, part, above);
    slice(k, part);
    std::swap(rest, above);
  }
  slice(last, rest);
}

using OfCorners = Eigen::Array<double, 4, 1>;  // of a grid cell's column: x fastest

// Integrals of s(x) s(y) w^p over the horizontal projection of a polygon, p = 0, 1, 2, where w is the height above the
// cell's floor; and those of p = 0, 1 times the distance from the corner along x and y.
struct Moments {
  OfCorners plan = OfCorners::Zero(), first = OfCorners::Zero(), second = OfCorners::Zero();
  std::array<OfCorners, 2> plan_along{OfCorners::Zero(), OfCorners::Zero()};
  std::array<OfCorners, 2> first_along{OfCorners::Zero(), OfCorners::Zero()};
};

Moments moments(const ConvexPolygon& segment, const Vector<double, 3>& floor) {
  Moments sum;
  const Vector<double, 3> a = segment[0] - floor;
  for (int k = 1; k + 1 < segment.size(); ++k) {
    const Vector<double, 3> b = segment[k] - floor, c = segment[k + 1] - floor;
    const double plan = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    for (const auto& [weight, twice] : triangle_rule) {
      const Vector<double, 3> all = twice * (a + b + c);
      for (const Vector<double, 3>* once : {&a, &b, &c}) {
        const Vector<double, 3> at = all + (1.0 - 3.0 * twice) * *once;
        const double u = at[0], v = at[1], w = at[2];
        const OfCorners fraction = (weight * plan) * OfCorners((1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v);
        sum.plan += fraction;
        sum.first += fraction * w;
        sum.second += fraction * (w * w);
        const std::array<OfCorners, 2> along{OfCorners(u, u - 1, u, u - 1), OfCorners(v, v, v - 1, v - 1)};
        for (std::size_t a = 0; a < 2; ++a) {
          sum.plan_along[a] += fraction * along[a];
          sum.first_along[a] += fraction * along[a] * w;
        }
      }
    }
  }
  return sum;
}

}  // namespace

SurfaceIntegrals::SurfaceIntegrals(const Vector<double, 3>& lowest, double cell, int edge, GroundAtNode<3>* nodes)
    : corner_(lowest.array() - cell),
      cell_(cell),
      edge_(edge),
      nodes_(nodes),
      moment_(static_cast<std::size_t>(edge * edge * edge), Vector<double, 3>::Zero()),
      top_(static_cast<std::size_t>((edge + 1) * (edge + 1)), -HUGE_VAL) {
  GroundAtNode<3> empty;
  empty.normal.setZero();
  std::fill_n(nodes, edge * edge * edge, empty);
}

void SurfaceIntegrals::add(const std::array<Vector<double, 3>, 3>& triangle) {
  std::array<Vector<double, 3>, 3> in_cells;
  std::transform(triangle.begin(), triangle.end(), in_cells.begin(),
                 [&](const Vector<double, 3>& point) -> Vector<double, 3> { return (point - corner_) / cell_; });
  const Vector<double, 3> up = (in_cells[1] - in_cells[0]).cross(in_cells[2] - in_cells[0]);
  const Facet facet{-up[0] / up[2], -up[1] / up[2], up.norm() / up[2]};
  for_slices(ConvexPolygon(in_cells), 0, edge_ + 1, [&](int column, const ConvexPolygon& strip) {
    if (column < 0 || column > edge_) {
      return;
    }
    for_slices(strip, 1, edge_ + 1, [&](int row, const ConvexPolygon& segment) {
      if (row >= 0 && row <= edge_) {
        add_to_column(column, row, facet, segment);
      }
    });
  });
}

void SurfaceIntegrals::add_to_column(int column, int row, const Facet& facet, const ConvexPolygon& segment) {
  double& top = top_[static_cast<std::size_t>(column + (edge_ + 1) * row)];
  top = std::max(top, segment.extent(2).greatest);
  for_slices(segment, 2, edge_ + 1, [&](int layer, const ConvexPolygon& part) {
    if (layer <= edge_) {
      add_to_cell(column, row, layer, facet, part);
    }
  });
}

void SurfaceIntegrals::add_to_cell(int column, int row, int layer, const Facet& facet, const ConvexPolygon& segment) {
  const Moments sum = moments(segment, Vector<double, 3>(column, row, layer));
  for (int corner = 0; corner < 4; ++corner) {
    const int i = column - 1 + corner % 2, j = row - 1 + corner / 2;
    if (i < 0 || j < 0 || i >= edge_ || j >= edge_) {
      continue;
    }
    const auto add = [&](int k, double surface, const Vector<double, 3>& from_node, double space) {
      GroundAtNode<3>& at = nodes_[node(i, j, k)];
      at.area += facet.stretch * surface;
      at.normal += surface * Vector<double, 3>(facet.slope_x, facet.slope_y, -1.0);
      at.space += space;
      moment_[static_cast<std::size_t>(node(i, j, k))] += facet.stretch * from_node;
    };
    // Integrals upwards from w: (1 - w)^2/2 for s = 1 - w at the floor's node, 1 - w^2/2 for s = w at the ceiling's
    // node.
    const double plan = sum.plan[corner], first = sum.first[corner], second = sum.second[corner];
    const auto along = [&](std::size_t a) { return sum.plan_along[a][corner]; };
    const auto first_along = [&](std::size_t a) { return sum.first_along[a][corner]; };
    if (layer >= 1) {
      add(layer - 1, plan - first,
          Vector<double, 3>(along(0) - first_along(0), along(1) - first_along(1), first - second),
          0.5 * (plan - 2.0 * first + second));
    }
    if (layer >= 0 && layer < edge_) {
      add(layer, first, Vector<double, 3>(first_along(0), first_along(1), second - first), plan - 0.5 * second);
    }
    for (int k = layer + 1; k < edge_; ++k) {
      nodes_[node(i, j, k)].space += plan;
    }
  }
}

void SurfaceIntegrals::finish() {
  constexpr double round_off = 1e-9;
  const auto top = [&](int column, int row) { return top_[static_cast<std::size_t>(column + (edge_ + 1) * row)]; };
  for (int j = 0; j < edge_; ++j) {
    for (int i = 0; i < edge_; ++i) {
      const double highest = std::max({top(i, j), top(i + 1, j), top(i, j + 1), top(i + 1, j + 1)});
      for (int k = 0; k < edge_; ++k) {
        GroundAtNode<3>& at = nodes_[node(i, j, k)];
        at.candidate = highest > k + round_off;
        at.space = at.candidate ? at.space * cell_ * cell_ * cell_ : cell_ * cell_ * cell_;
        const double resultant = at.normal.norm();
        if (at.area > least_area) {
          at.normal /= resultant;
          at.bend = at.area / resultant;
          const Vector<double, 3> centre = moment_[static_cast<std::size_t>(node(i, j, k))] / at.area;
          at.plane = at.normal.dot(corner_ + cell_ * (Vector<double, 3>(i + 1, j + 1, k + 1) + centre));
        } else {
          at.normal.setZero();
        }
        at.area *= cell_ * cell_;
      }
    }
  }
}

void SurfaceIntegrals::finish_in_space() {
  for (int k = 0; k < edge_ * edge_ * edge_; ++k) {
    nodes_[k].space = cell_ * cell_ * cell_;
  }
}

void SurfaceIntegrals::finish_in_ground() {
  for (int k = 0; k < edge_ * edge_ * edge_; ++k) {
    nodes_[k].candidate = true;
  }
}

}  // namespace thawslide::terrain
