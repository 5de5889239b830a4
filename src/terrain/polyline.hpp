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

}  // namespace thawslide::terrain
