// Ground as a polyline over x, extruded along y in 3D. Ground data at nodes follow from the line itself or, as
// published, from rigid points along it.
#pragma once

#include "mpm/section_width.hpp"
#include "terrain/polyline.hpp"
#include "terrain/surface.hpp"

namespace thawslide::terrain {

template <int Dim>
class ProfileSurface final : public Surface<Dim> {
 public:
  using Point = typename Surface<Dim>::Point;
  using NodeIndex = typename Surface<Dim>::NodeIndex;

  // width: of a 2D section.
  explicit ProfileSurface(Polyline line, mpm::SectionWidth width = {})
      : line_(std::move(line)), width_(std::move(width)) {}
  // Ground data from rigid points in `layers` layers, `spacing` [m] apart.
  ProfileSurface(Polyline line, double spacing, int layers, mpm::SectionWidth width = {})
      : line_(std::move(line)), width_(std::move(width)), spacing_(spacing), layers_(layers) {}

  [[nodiscard]] double height(const Point& point) const override { return line_.height(point[0]); }
  [[nodiscard]] typename Surface<Dim>::ColumnMeans column_means(const Point& at, double cell) const override {
    const Polyline::HatMeans means = line_.hat_means(at[0], cell);
    return {means.height, means.length};
  }
  // Gradient of the segment at the place, independent of the width.
  [[nodiscard]] Point gradient(const Point& point, double width) const override;
  [[nodiscard]] double highest(const Point& from, const Point& to) const override {
    return line_.highest(from[0], to[0]);
  }
  [[nodiscard]] double steepest(const Point& from, const Point& to) const override {
    return line_.steepest(from[0], to[0]);
  }
  void at_block(const NodeIndex& first, double cell, int edge, GroundAtNode<Dim>* nodes) const override;

  [[nodiscard]] GroundAtNode<Dim> at_node(const Vector<double, Dim>& position, double cell) const;

 private:
  void fit_to_points(double x, double height, double cell, GroundAtNode<Dim>& node) const;

  Polyline line_;
  mpm::SectionWidth width_;
  double spacing_ = 0;  // of the rigid points; 0: none, the line itself is the ground
  int layers_ = 0;
};

}  // namespace thawslide::terrain
