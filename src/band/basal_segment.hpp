// Basal segment: a part of the base that carries a band column (physics/band_column.hpp) and moves with the sliding
// mass. For host and device.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "base/linear.hpp"
#include "physics/band_column_step.hpp"

namespace thawslide::band {

template <int Dim>
struct SegmentShape {
  using Sides = Eigen::Matrix<double, Dim, Dim - 1>;

  Vector<double, Dim> position;  // of its centre, on the ground [m]
  Vector<double, Dim> normal;    // unit vector into the ground
  Sides sides;                   // its edges along the ground [m]; one in 2D
};

template <int Dim>
struct BasalSegment : SegmentShape<Dim> {
  std::int64_t id = 0;
  // Velocity of the sliding mass around the segment, along the ground, at the column's last step [m/s].
  Vector<double, Dim> velocity = Vector<double, Dim>::Zero();
  double area = 0;             // [m2]; [m2 per metre of width] in 2D
  double area_of_column = 0;   // reference area of the column's quantities per area [m2]
  double slip = 0;             // [m]
  double speed = 0;            // of slip [m/s]
  double load = 0;             // normal pressure N, averaged over time [Pa]
  double depth = 0;            // flow depth above, along the normal, from the load on the segment, averaged [m]
  double loaded_for = 0;       // averaging time of the depth so far [s]
  double heat = 0;             // friction heat on the whole area since the column's last step [J]
  bool touched = false;        // has carried load before
  physics::BandMeans means{};  // of the column at its last step, under the load at that time
  double liquid = 0;           // liquid water in the column at its last step, per area [m]
  physics::BandColumn column;  // last: between its steps only its first numbers are read
};

template <int Dim>
THAWSLIDE_HD double area_of(const Eigen::Matrix<double, Dim, Dim - 1>& sides) {
  if constexpr (Dim == 2) {
    return sides.norm();
  } else {
    return sides.col(0).cross(sides.col(1)).norm();
  }
}

// Edge of a square of an area [m2]; in 2D, of a line.
template <int Dim>
THAWSLIDE_HD double edge_of_face(double area) {
  return Dim == 2 ? area : std::sqrt(area);
}

// Edges of a segment whose horizontal projection has length `size` along each axis.
template <int Dim>
THAWSLIDE_HD Eigen::Matrix<double, Dim, Dim - 1> sides_on(const Vector<double, Dim>& normal,
                                                          const Vector<double, Dim - 1>& size) {
  Eigen::Matrix<double, Dim, Dim - 1> sides = Eigen::Matrix<double, Dim, Dim - 1>::Zero();
  for (int a = 0; a + 1 < Dim; ++a) {
    sides(a, a) = size[a];
    sides(Dim - 1, a) = -normal[a] / normal[Dim - 1] * size[a];
  }
  return sides;
}

// Rotates v by the smallest rotation that takes the unit vector `from` to `to`.
template <int Dim>
THAWSLIDE_HD Vector<double, Dim> turned(const Vector<double, Dim>& v, const Vector<double, Dim>& from,
                                        const Vector<double, Dim>& to) {
  const Vector<double, Dim> both = from + to;
  const double along = 1.0 + from.dot(to);
  return along > round_off ? Vector<double, Dim>(v - both * (both.dot(v) / along) + 2.0 * from.dot(v) * to) : v;
}

}  // namespace thawslide::band
