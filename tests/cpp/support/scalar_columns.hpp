// Reference for band/flow_depth: flow depth at particles, computed column by column and particle by particle.
#pragma once

#include <algorithm>

#include "scalar_points.hpp"

namespace thawslide::testing_support {

template <int Dim>
class ScalarColumns {
 public:
  // slope_cosine(x [m]): of the ground.
  template <class Cosine>
  ScalarColumns(const std::vector<Point<Dim>>& points, double cell, const Cosine& slope_cosine) : cell_(cell) {
    for (const Point<Dim>& p : points) {
      for_columns(p, [&](const Column& column, double fraction, const Extent& from, const Extent& to) {
        Held& held = held_[column];
        held.volume += fraction * p.volume;
        held.mass += fraction * p.mass;
        held.top = std::max(held.top, p.position[Dim - 1] + p.half * cell_);
        for (std::size_t a = 0; a + 1 < Dim; ++a) {
          held.from[a] = std::min(held.from[a], from[a]);
          held.to[a] = std::max(held.to[a], to[a]);
        }
        held.cosine = slope_cosine((column[0] + 0.5) * cell_);
      });
    }
    for (auto& [column, held] : held_) {
      held.thickness = held.volume / footprint(column, held);
    }
  }

  [[nodiscard]] double flow_depth(const Point<Dim>& p) const {
    return over_columns(p, [](const Held& held) { return held.cosine; });
  }

  // N [Pa]; normal_gravity: component of gravity normal to the ground, per unit of footprint [m/s2].
  [[nodiscard]] double normal_load(const Point<Dim>& p, double normal_gravity) const {
    return over_columns(p, [&](const Held& held) { return held.mass / held.volume * normal_gravity; });
  }

  // Position of the particle's centre [m].
  [[nodiscard]] double below_top(const Point<Dim>& p) const {
    Column column;
    for (std::size_t a = 0; a + 1 < Dim; ++a) {
      column[a] = static_cast<int>(std::floor(p.position[static_cast<int>(a)] / cell_));
    }
    return held_.at(column).top - p.position[Dim - 1];
  }

 private:
  using Column = std::array<int, Dim - 1>;
  using Extent = std::array<double, Dim - 1>;
  struct Held {
    double volume = 0.0, mass = 0.0, top = -HUGE_VAL, cosine = 1.0, thickness = 0.0;
    Extent from, to;

    Held() {
      from.fill(HUGE_VAL);
      to.fill(-HUGE_VAL);
    }
  };

  // Sum of the vertical depths in the columns, each multiplied by factor(column).
  template <class Factor>
  [[nodiscard]] double over_columns(const Point<Dim>& p, const Factor& factor) const {
    double sum = 0.0;
    for_columns(p, [&](const Column& column, double fraction, const Extent& /*from*/, const Extent& /*to*/) {
      const Held& held = held_.at(column);
      sum += fraction * factor(held) * (p.in_band ? held.thickness : std::max(0.0, held.top - p.position[Dim - 1]));
    });
    return sum;
  }

  // Calls visit(column, share, from, to) for the columns that a particle's box overlaps by more than round-off.
  template <class Visit>
  void for_columns(const Point<Dim>& p, const Visit& visit) const {
    constexpr double sliver = 1e-9;
    for (int corner = 0; corner < 1 << (Dim - 1); ++corner) {
      Column column;
      Extent from, to;
      double fraction = 1.0;
      for (std::size_t a = 0; a + 1 < Dim; ++a) {
        const double half = p.half * cell_, middle = p.position[static_cast<int>(a)];
        const double begin = middle - half, end = middle + half;
        column[a] = static_cast<int>(std::floor((begin + sliver * half) / cell_)) + (corner >> a & 1);
        from[a] = std::max(begin, column[a] * cell_);
        to[a] = std::min(end, (column[a] + 1) * cell_);
        fraction *= to[a] - from[a] > sliver * half ? (to[a] - from[a]) / (2.0 * half) : 0.0;
      }
      if (fraction > 0.0) {
        visit(column, fraction, from, to);
      }
    }
  }

  // [m2], per metre of width in 2D: area of the cell or, at the edge of the body, the part covered by boxes.
  [[nodiscard]] double footprint(const Column& column, const Held& held) const {
    double product = 1.0;
    for (std::size_t a = 0; a + 1 < Dim; ++a) {
      Column before = column, after = column;
      --before[a];
      ++after[a];
      const bool inside = held_.count(before) == 1 && held_.count(after) == 1;
      product *= inside ? cell_ : std::min(cell_, held.to[a] - held.from[a]);
    }
    return product;
  }

  double cell_;
  std::map<Column, Held> held_;
};

}  // namespace thawslide::testing_support
