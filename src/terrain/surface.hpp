// The surface that bodies slide on, over the horizontal plane: what every kind of ground must tell. Coordinates are
// relative to the domain's lower corner [m]; the vertical is the last axis.
#pragma once

#include "base/linear.hpp"

namespace thawslide::terrain {

// What a node knows of the ground, computed once.
template <int Dim, class Real>
struct GroundAtNode {
  bool candidate = false;    // the node's linear shape function overlaps the ground
  Vector<Real, Dim> normal;  // unit vector from the slide into the ground
  Real area = 0;             // integral of the shape function over the ground's surface [m2]; sums to that surface
  Real space = 0;            // integral of the shape function over the space above the ground [m3]
  Real distance = 0;         // from the ground, positive above it [m]
};

template <int Dim>
class Surface {
 public:
  using Place = Vector<double, Dim - 1>;  // x in 2D; x, y in 3D

  virtual ~Surface() = default;

  // Elevation at a place [m], and its gradient there.
  [[nodiscard]] virtual double height(const Place& place) const = 0;
  [[nodiscard]] virtual Place gradient(const Place& place) const = 0;
  // Highest and lowest elevation over the rectangle between two places [m].
  [[nodiscard]] virtual double highest(const Place& from, const Place& to) const = 0;

  // Fills what the `edge`^Dim nodes of a block know, x fastest. `lowest` is the position of its first node; cells are
  // `cell` wide.
  virtual void at_block(const Vector<double, Dim>& lowest, double cell, int edge,
                        GroundAtNode<Dim, double>* nodes) const = 0;

  // Whether the ground is known at a place, and all over the rectangle between two places. Where it is not, the other
  // functions go on as best they can.
  [[nodiscard]] virtual bool is_known(const Place& /*place*/) const { return true; }
  [[nodiscard]] virtual bool is_known(const Place& /*from*/, const Place& /*to*/) const { return true; }

  // Cosine of the slope against the grid's axes at a place.
  [[nodiscard]] double slope_cosine(const Place& place) const {
    return 1.0 / std::sqrt(1.0 + gradient(place).squaredNorm());
  }
  // Unit normal into the ground below a place.
  [[nodiscard]] Vector<double, Dim> normal_below(const Place& place) const {
    Vector<double, Dim> normal;
    normal.template head<Dim - 1>() = gradient(place);
    normal[Dim - 1] = -1.0;
    return normal.normalized();
  }
};

}  // namespace thawslide::terrain
