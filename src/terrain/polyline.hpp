// Polyline over x, and the ground that it describes: flat, a plane or a profile. Coordinates are relative to the
// domain's lower corner [m].
#pragma once

#include <vector>

#include "base/linear.hpp"
#include "terrain/surface.hpp"

namespace thawslide::terrain {

// Beyond its ends, the polyline continues with the gradient of its end segments.
class Polyline {
 public:
  // x strictly ascending [m], at least two points.
  Polyline(std::vector<double> x, std::vector<double> height);

  [[nodiscard]] double height(double x) const;
  // dh/dx of the segment that contains x.
  [[nodiscard]] double gradient(double x) const;
  // Largest |dh/dx| of the segments over [from, to].
  [[nodiscard]] double steepest(double from, double to) const;

  // Means over the hat function max(0, 1 - |u - x|/cell): height [m], and length of the ground per horizontal length.
  // Exact for a polyline.
  struct HatMeans {
    double height = 0, length = 0;
  };
  [[nodiscard]] HatMeans hat_means(double x, double cell) const;

  [[nodiscard]] const std::vector<double>& x() const { return x_; }
  [[nodiscard]] const std::vector<double>& heights() const { return height_; }

 private:
  [[nodiscard]] std::size_t segment(double x) const;

  std::vector<double> x_, height_;
};

// Ground as a polyline over x, extruded along y in 3D.
template <int Dim>
class ProfileSurface final : public Surface<Dim> {
 public:
  using Point = typename Surface<Dim>::Point;

  explicit ProfileSurface(Polyline line) : line_(std::move(line)) {}

  [[nodiscard]] double height(const Point& point) const override { return line_.height(point[0]); }
  [[nodiscard]] typename Surface<Dim>::ColumnMeans column_means(const Point& at, double cell) const override {
    const Polyline::HatMeans means = line_.hat_means(at[0], cell);
    return {means.height, means.length};
  }
  // Gradient of the segment at the place, independent of the width.
  [[nodiscard]] Point gradient(const Point& point, double /*width*/) const override {
    Point gradient = Point::Zero();
    gradient[0] = line_.gradient(point[0]);
    return gradient;
  }
  [[nodiscard]] double steepest(const Point& from, const Point& to) const override {
    return line_.steepest(from[0], to[0]);
  }

 private:
  Polyline line_;
};

}  // namespace thawslide::terrain
