// Front of the sliding mass: travel distance exceeded by only the foremost 0.5 % of the mass. For host and device.
#pragma once

#include <cstdint>

#include "base/line_view.hpp"

namespace thawslide::mpm {

// Particle position along the path of the front.
struct PathSample {
  double along = 0.0, mass = 0.0;  // [m, kg]
  Point2 position{};               // [m]; only x in 2D
};

// Path along a line, or along the x axis if the line has no segments.
template <int Dim>
struct Transformation {
  LineView line;
  Point2 origin{};  // of positions [m]

  template <class Particles>
  [[nodiscard]] THAWSLIDE_HD PathSample of(const Particles& particles, std::uint32_t p) const {
    PathSample found;
    found.mass = static_cast<double>(particles.mass(p));
    for (int a = 0; a < Dim - 1; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      found.position[axis] = static_cast<double>(particles.position(p, a)) + origin[axis];
    }
    found.along = line.segments == 0 ? found.position[0] : line.project(found.position).along;
    return found;
  }
};

// Search from the foremost particle backwards, in a body of a given mass [kg].
class FrontSearch {
 public:
  explicit FrontSearch(double mass) : mass_(mass) {}

  // True if the front is at the next particle: the mass behind it is below `fraction` of the whole.
  [[nodiscard]] bool is_at(double mass_of_next) {
    ahead_ += mass_of_next;
    return mass_ - ahead_ < fraction * mass_;
  }

 private:
  static constexpr double fraction = 0.995;

  double mass_, ahead_ = 0.0;
};

}  // namespace thawslide::mpm
