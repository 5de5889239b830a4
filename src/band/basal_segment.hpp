// Basal segment: a part of the base that carries a band column (physics/band_column.hpp) and moves with the sliding
// mass.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "base/linear.hpp"
#include "mpm/sparse_grid.hpp"
#include "physics/band_column_step.hpp"

namespace thawslide::band {

template <int Dim>
struct BasalSegment {
  using Sides = Eigen::Matrix<double, Dim, Dim - 1>;

  std::int64_t id = 0;
  Vector<double, Dim> position;  // of its centre, on the ground [m]
  Vector<double, Dim> normal;    // unit vector into the ground
  // Velocity of the sliding mass around the segment, along the ground, at the column's last step [m/s].
  Vector<double, Dim> velocity = Vector<double, Dim>::Zero();
  Sides sides;                // its edges along the ground [m]; one in 2D
  double area = 0;            // [m2]; [m2 per metre of width] in 2D
  double area_of_column = 0;  // reference area of the column's quantities per area [m2]
  double slip = 0;            // [m]
  double speed = 0;           // of slip [m/s]
  double load = 0;            // normal pressure N, averaged over time [Pa]
  double depth = 0;           // flow depth above, along the normal, from the load on the segment, averaged [m]
  double loaded_for = 0;      // averaging time of the depth so far [s]
  double heat = 0;            // friction heat on the whole area since the column's last step [J]
  bool touched = false;       // has carried load before
  physics::BandColumn column;
  physics::BandMeans means{};  // of the column at its last step, under the load at that time
  double liquid = 0;           // liquid water in the column at its last step, per area [m]
};

template <int Dim>
double area_of(const Eigen::Matrix<double, Dim, Dim - 1>& sides) {
  if constexpr (Dim == 2) {
    return sides.norm();
  } else {
    return sides.col(0).cross(sides.col(1)).norm();
  }
}

// Edges of a segment whose horizontal projection has length `size` along each axis.
template <int Dim>
Eigen::Matrix<double, Dim, Dim - 1> sides_on(const Vector<double, Dim>& normal, const Vector<double, Dim - 1>& size) {
  Eigen::Matrix<double, Dim, Dim - 1> sides = Eigen::Matrix<double, Dim, Dim - 1>::Zero();
  for (int a = 0; a + 1 < Dim; ++a) {
    sides(a, a) = size[a];
    sides(Dim - 1, a) = -normal[a] / normal[Dim - 1] * size[a];
  }
  return sides;
}

// Rotates v by the smallest rotation that takes the unit vector `from` to `to`.
template <int Dim>
Vector<double, Dim> turned(const Vector<double, Dim>& v, const Vector<double, Dim>& from,
                           const Vector<double, Dim>& to) {
  const Vector<double, Dim> both = from + to;
  const double along = 1.0 + from.dot(to);
  return along > round_off ? Vector<double, Dim>(v - both * (both.dot(v) / along) + 2.0 * from.dot(v) * to) : v;
}

// Nodes within reach of a basal segment, with the weights of cubic B-splines, which reach two cells along each axis.
// Nodes with contact lie within 1.25 cells of the ground, and their footpoints within half a cell of a new segment.
// Valid until the blocks of the grid change.
template <int Dim>
class BaseStencil {
 public:
  using T = mpm::Tile<Dim>;
  static constexpr int width = 4;

  BaseStencil() = default;  // without nodes
  BaseStencil(const mpm::SparseGrid<Dim>& grid, const Vector<double, Dim>& position) : cell_(grid.cell()) {
    typename T::Index below, tile;
    for (std::size_t a = 0; a < Dim; ++a) {
      const bool is_vertical = a + 1 == Dim;  // the segment is on layer 0
      const double in_cells = is_vertical ? 0.0 : position[static_cast<int>(a)] * grid.inverse_cell();
      below[a] = static_cast<int>(std::floor(in_cells));
      weight_[a] = cubic_weights(in_cells - std::floor(in_cells));
      first_[a] = (std::floor(in_cells) - 1.0 - in_cells) * grid.cell();
    }
    T::split(below, tile, local_);
    const auto found = std::lower_bound(grid.blocks().begin(), grid.blocks().end(), T::key(tile));
    if (found == grid.blocks().end() || *found != T::key(tile)) {
      return;  // no part of the sliding mass is near
    }
    about_ = grid.blocks_about_block(static_cast<std::size_t>(found - grid.blocks().begin()));
    for (int a = 0; a < Dim; ++a) {
      for (int k = 0; k < width; ++k) {
        const typename T::Adjacent adjacent = T::adjacent(local_, a, k - 1);
        direction_[a][k] = adjacent.direction - T::stencil / 2;
        shift_[a][k] = adjacent.local - local_;
        of_first_[a] += direction_[a][k] == direction_[a][0] ? 1 : 0;
      }
    }
  }

  // Calls visit(block, node, weight, from_segment) for each node, x fastest. from_segment: vector from the segment to
  // the node [m].
  template <class Visit>
  THAWSLIDE_ALWAYS_INLINE void for_each_with_offset(const Visit& visit) const {
    Vector<double, Dim> from_segment;
    for (int row = 0; about_ != nullptr && row < mpm::power(width, Dim - 1); ++row) {
      int direction = T::stencil / 2, first = local_;
      double of_row = 1.0;
      for (int a = 1, rest = row; a < Dim; ++a, rest /= width) {
        const int k = rest % width;
        direction += direction_[a][k];
        first += shift_[a][k];
        of_row *= weight_[static_cast<std::size_t>(a)][static_cast<std::size_t>(k)];
        from_segment[a] = first_[static_cast<std::size_t>(a)] + static_cast<double>(k) * cell_;
      }
      for (int x = 0; x < width; ++x) {
        const std::int32_t block = about_[direction + direction_[0][x]];
        const double weight = weight_[0][static_cast<std::size_t>(x)] * of_row;
        if (block != KeyIndex::absent && weight > 0.0) {
          from_segment[0] = first_[0] + static_cast<double>(x) * cell_;
          visit(static_cast<std::size_t>(block), static_cast<std::size_t>(first + shift_[0][x]), weight, from_segment);
        }
      }
    }
  }
  template <class Visit>
  THAWSLIDE_ALWAYS_INLINE void for_each(const Visit& visit) const {
    for_each_with_offset([&](std::size_t block, std::size_t node, double weight,
                             const Vector<double, Dim>& /*from_segment*/) { visit(block, node, weight); });
  }
  // The nodes lie in one or two blocks along each axis. Calls visit(block, corner) for each active one of these blocks;
  // bit a of a corner is set for the second block along axis a.
  template <class Visit>
  void for_each_block(const Visit& visit) const {
    for (int corner = 0; about_ != nullptr && corner < mpm::power(2, Dim); ++corner) {
      int direction = T::stencil / 2;
      bool is_present = true;
      for (int a = 0; a < Dim; ++a) {
        const bool second = (corner >> a & 1) != 0;
        direction += direction_[a][second ? width - 1 : 0];
        is_present = is_present && !(second && of_first_[a] == width);
      }
      if (is_present && about_[direction] != KeyIndex::absent) {
        visit(static_cast<std::size_t>(about_[direction]), corner);
      }
    }
  }
  // Calls visit(node, weight) for each node in the block of a corner.
  template <class Visit>
  THAWSLIDE_ALWAYS_INLINE void for_each_in(int corner, const Visit& visit) const {
    int first[3] = {0, 0, 0}, end[3] = {1, 1, 1};
    for (int a = 0; a < Dim; ++a) {
      const bool second = (corner >> a & 1) != 0;
      first[a] = second ? of_first_[a] : 0;
      end[a] = second ? width : of_first_[a];
    }
    for (int z = first[2]; z < end[2]; ++z) {
      for (int y = first[1]; y < end[1]; ++y) {
        for (int x = first[0]; x < end[0]; ++x) {
          double weight = weight_[0][static_cast<std::size_t>(x)] * weight_[1][static_cast<std::size_t>(y)];
          int node = local_ + shift_[0][x] + shift_[1][y];
          if constexpr (Dim == 3) {
            weight *= weight_[2][static_cast<std::size_t>(z)];
            node += shift_[2][z];
          }
          if (weight > 0.0) {
            visit(static_cast<std::size_t>(node), weight);
          }
        }
      }
    }
  }

 private:
  // Weights of the four nodes around a position at fraction t between the inner two.
  static std::array<double, width> cubic_weights(double t) {
    const double s = 1.0 - t, sixth = 1.0 / 6.0;
    return {sixth * s * s * s, sixth * (4.0 - 3.0 * t * t * (2.0 - t)), sixth * (4.0 - 3.0 * s * s * (2.0 - s)),
            sixth * t * t * t};
  }

  const std::int32_t* about_ = nullptr;  // blocks around that of the node below the segment
  int local_ = 0;                        // that node, in its tile
  double cell_ = 0;                      // [m]
  std::array<double, Dim> first_;        // from the segment to the first node along each axis [m]
  std::array<std::array<double, width>, Dim> weight_;
  int direction_[Dim][width], shift_[Dim][width];  // along each axis: to its block, and from the node below
  int of_first_[Dim] = {};                         // nodes along each axis in the first block
};

}  // namespace thawslide::band
