// Convex polygons in space with few corners, stored without allocation, and their intersection with planes normal to an
// axis.
#pragma once

#include <algorithm>
#include <array>

#include "base/error.hpp"
#include "base/linear.hpp"

namespace thawslide::terrain {

class ConvexPolygon {
 public:
  // A triangle cut by two planes across each axis has at most nine corners.
  static constexpr int capacity = 12;

  ConvexPolygon() = default;
  explicit ConvexPolygon(const std::array<Vector<double, 3>, 3>& triangle) : size_(3) {
    std::copy(triangle.begin(), triangle.end(), corner_.begin());
  }

  // Copies only the used corners.
  ConvexPolygon(const ConvexPolygon& other) : size_(other.size_) {
    std::copy_n(other.corner_.begin(), size_, corner_.begin());
  }
  ConvexPolygon& operator=(const ConvexPolygon& other) {
    size_ = other.size_;
    std::copy_n(other.corner_.begin(), size_, corner_.begin());
    return *this;
  }
  ~ConvexPolygon() = default;

  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] const Vector<double, 3>& operator[](int k) const { return corner_[static_cast<std::size_t>(k)]; }

  void clear() { size_ = 0; }
  void push_back(const Vector<double, 3>& corner) {
    THAWSLIDE_ASSERT(size_ < capacity, "a polygon of more than {} corners", capacity);
    corner_[static_cast<std::size_t>(size_++)] = corner;
  }

  // Area of the projection on the horizontal plane, positive for corners counter-clockwise from above.
  [[nodiscard]] double plan_area() const {
    double twice = 0.0;
    for (int k = 1; k + 1 < size_; ++k) {
      const Vector<double, 3> to_next = (*this)[k] - (*this)[0], to_last = (*this)[k + 1] - (*this)[0];
      twice += to_next[0] * to_last[1] - to_next[1] * to_last[0];
    }
    return 0.5 * twice;
  }

  // Part over the rectangle between two corners, including its sides.
  [[nodiscard]] ConvexPolygon over(const Vector<double, 2>& from, const Vector<double, 2>& to) const {
    ConvexPolygon part = *this, kept, outside;
    for (int axis = 0; axis < 2; ++axis) {
      if (part.reaches(axis, -1.0, from[axis])) {
        part.split(axis, from[axis], outside, kept);
        part = kept;
      }
      if (part.reaches(axis, 1.0, to[axis])) {
        part.split(axis, to[axis], kept, outside);
        part = kept;
      }
    }
    return part;
  }

  // Parts on both sides of the plane where the coordinate along `axis` is `at`. A polygon on one side is not cut.
  void split(int axis, double at, ConvexPolygon& below, ConvexPolygon& above) const {
    below.clear();
    above.clear();
    if (!reaches(axis, -1.0, at) || !reaches(axis, 1.0, at)) {  // on one side
      (reaches(axis, -1.0, at) ? below : above) = *this;
      return;
    }
    for (int k = 0; k < size_; ++k) {
      const Vector<double, 3>& here = (*this)[k];
      const Vector<double, 3>& next = (*this)[k + 1 == size_ ? 0 : k + 1];
      const double from = here[axis] - at;
      const double to = next[axis] - at;
      if (from <= 0.0) {
        below.push_back(here);
      }
      if (from >= 0.0) {
        above.push_back(here);
      }
      if ((from < 0.0 && to > 0.0) || (from > 0.0 && to < 0.0)) {
        Vector<double, 3> cut = here + (next - here) * (from / (from - to));
        cut[axis] = at;
        below.push_back(cut);
        above.push_back(cut);
      }
    }
  }

 private:
  // True if a corner lies beyond the plane at a coordinate, in the direction of a sign.
  [[nodiscard]] bool reaches(int axis, double sign, double at) const {
    return std::any_of(corner_.begin(), corner_.begin() + size_,
                       [&](const Vector<double, 3>& corner) { return sign * (corner[axis] - at) > 0.0; });
  }

  int size_ = 0;
  std::array<Vector<double, 3>, capacity> corner_;
};

}  // namespace thawslide::terrain
