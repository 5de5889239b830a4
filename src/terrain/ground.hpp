// The rigid ground, as a signed distance. A polyline over x serves flat ground, a plane and a profile alike; in 3D it
// is extruded along y. Coordinates are relative to the domain's lower corner [m].
#pragma once

#include <vector>

#include "base/linear.hpp"

namespace thawslide::terrain {

// Beyond its ends the polyline goes on with the gradient of its last segments.
class Polyline {
 public:
  // x strictly ascending [m], at least two points.
  Polyline(std::vector<double> x, std::vector<double> height);

  [[nodiscard]] double height(double x) const;
  // dh/dx of the segment that holds x.
  [[nodiscard]] double gradient(double x) const;
  // Highest point over [from, to].
  [[nodiscard]] double highest(double from, double to) const;

  struct Nearest {
    double distance;           // [m], positive above the ground
    Vector<double, 2> normal;  // unit vector from above into the ground
  };
  [[nodiscard]] Nearest nearest(double x, double height) const;

  // What the ground takes of a node's linear hat S of half-width `cell`, centred at (x, height): exact for a polyline.
  struct HatShare {
    double length;  // integral of S along the ground [m]
    double above;   // integral of S over the space above the ground [m2]
  };
  [[nodiscard]] HatShare hat_share(double x, double height, double cell) const;

  [[nodiscard]] const std::vector<double>& x() const { return x_; }
  [[nodiscard]] const std::vector<double>& heights() const { return height_; }

 private:
  [[nodiscard]] std::size_t segment(double x) const;

  std::vector<double> x_, height_;
};

// What a node knows of the ground, computed once.
template <int Dim, class Real>
struct GroundAtNode {
  bool candidate = false;    // the node's linear hat overlaps the ground
  Vector<Real, Dim> normal;  // unit vector from the slide into the ground
  Real area = 0;             // integral of the hat over the ground's surface [m2]; sums to that surface
  Real space = 0;            // integral of the hat over the space above the ground [m3]
  Real distance = 0;         // from the ground, positive above it [m]
};

// The ground a run uses; the vertical is the last axis.
template <int Dim>
class Ground {
 public:
  explicit Ground(Polyline line) : line_(std::move(line)) {}
  // Nodes learn of the ground from rigid points in `layers` layers, `spacing` [m] apart.
  Ground(Polyline line, double spacing, int layers) : line_(std::move(line)), spacing_(spacing), layers_(layers) {}

  [[nodiscard]] const Polyline& line() const { return line_; }

  template <class Real>
  [[nodiscard]] GroundAtNode<Dim, Real> at_node(const Vector<Real, Dim>& position, Real cell) const;

  // Cosine of the slope against the grid axes, at a horizontal place.
  [[nodiscard]] double slope_cosine(double x) const;
  // Unit normal into the ground below a horizontal place.
  [[nodiscard]] Vector<double, Dim> normal_below(double x) const;

 private:
  void learn_from_points(double x, double height, double cell, GroundAtNode<Dim, double>& node) const;

  Polyline line_;
  double spacing_ = 0;  // of the rigid points; 0: none, the line itself is the ground
  int layers_ = 0;
};

}  // namespace thawslide::terrain
