// Ground as a polyline over x, extruded along y in 3D.
#pragma once

#include "terrain/polyline.hpp"
#include "terrain/surface.hpp"

namespace thawslide::terrain {

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
