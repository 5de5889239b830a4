// Polyline over x: flat ground, a plane or a profile. Coordinates are relative to the domain's lower corner [m].
#pragma once

#include <vector>

#include "base/linear.hpp"

namespace thawslide::terrain {

// Beyond its ends, the polyline continues with the gradient of its end segments.
class Polyline {
 public:
  // x strictly ascending [m], at least two points.
  Polyline(std::vector<double> x, std::vector<double> height);

  [[nodiscard]] double height(double x) const;
  // dh/dx of the segment that contains x.
  [[nodiscard]] double gradient(double x) const;
  // Highest point over [from, to], and largest |dh/dx| of the segments there.
  [[nodiscard]] double highest(double from, double to) const;
  [[nodiscard]] double steepest(double from, double to) const;

  struct Nearest {
    double distance;           // [m], positive above the ground
    Vector<double, 2> normal;  // unit vector from above into the ground
  };
  [[nodiscard]] Nearest nearest(double x, double height) const;

  // Integrals over the ground of a node's linear shape function S of half-width `cell`, centred at (x, height). Exact
  // for a polyline.
  struct LinearFraction {
    double length = 0;                                        // B = integral of S along the ground [m]
    double above = 0;                                         // integral of S over the space above it [m2]
    Vector<double, 2> resultant = Vector<double, 2>::Zero();  // G = integral of S n, n from above into it [m]
    Vector<double, 2> moment = Vector<double, 2>::Zero();     // integral of S (place - node) along it [m2]
  };
  [[nodiscard]] LinearFraction linear_fraction(double x, double height, double cell) const;

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

}  // namespace thawslide::terrain
