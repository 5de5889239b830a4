// The front of a slide: how far all but the foremost 0.5 % of its mass has come. For host and device.
#pragma once

#include <cstdint>

#include "base/line_view.hpp"

namespace thawslide::mpm {

// A particle on the way that the front is measured on.
struct PathSample {
  double along = 0.0, mass = 0.0;  // [m, kg]
  Place2 place{};                  // [m]; in 2D x alone
};

// Along a line, or, where that has no segments, along the x axis.
template <int Dim>
struct Transformation {
  LineView line;
  Place2 origin{};  // of positions [m]

  template <class Particles>
  [[nodiscard]] THAWSLIDE_HD PathSample of(const Particles& particles, std::uint32_t p) const {
    PathSample found;
    found.mass = static_cast<double>(particles.mass(p));
    for (int a = 0; a < Dim - 1; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      found.place[axis] = static_cast<double>(particles.position(p, a)) + origin[axis];
    }
    found.along = line.segments == 0 ? found.place[0] : line.project(found.place).along;
    return found;
  }
};

// Goes from the foremost particle back, of a slide of some mass [kg].
class FrontSearch {
 public:
  explicit FrontSearch(double mass) : mass_(mass) {}

  // Whether the front is at the next particle: what lies behind it is less than the share.
  [[nodiscard]] bool is_at(double mass_of_next) {
    ahead_ += mass_of_next;
    return mass_ - ahead_ < share * mass_;
  }

 private:
  static constexpr double share = 0.995;

  double mass_, ahead_ = 0.0;
};

}  // namespace thawslide::mpm
