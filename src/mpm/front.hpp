// Front of the sliding mass: travel distance exceeded by only the foremost 0.5 % of the mass of bodies that have moved.
// For host and device.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "base/line_view.hpp"

namespace thawslide::mpm {

// Set of bodies by number; those from the 256th on are in it together.
struct BodySet {
  std::array<std::uint64_t, 4> words{};

  THAWSLIDE_HD void add(std::size_t body) { words[place(body) / 64] |= bit(body); }
  [[nodiscard]] THAWSLIDE_HD bool contains(std::size_t body) const {
    return (words[place(body) / 64] & bit(body)) != 0;
  }
  THAWSLIDE_HD BodySet& operator|=(const BodySet& other) {
    for (std::size_t k = 0; k < words.size(); ++k) {
      words[k] |= other.words[k];
    }
    return *this;
  }

 private:
  [[nodiscard]] THAWSLIDE_HD static std::size_t place(std::size_t body) { return body < 255 ? body : 255; }
  [[nodiscard]] THAWSLIDE_HD static std::uint64_t bit(std::size_t body) {
    return std::uint64_t{1} << (place(body) % 64);
  }
};

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
  bool all = true;  // all bodies count; otherwise only those of a set: others have no mass here, and are behind all
  BodySet bodies{};

  template <class Particles>
  [[nodiscard]] THAWSLIDE_HD PathSample of(const Particles& particles, std::uint32_t p) const {
    PathSample found;
    if (!all && !bodies.contains(static_cast<std::size_t>(particles.body(p)))) {
      found.along = -HUGE_VAL;
      return found;
    }
    found.mass = particles.mass(p);
    for (int a = 0; a < Dim - 1; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      found.position[axis] = particles.position(p, a) + origin[axis];
    }
    found.along = line.segments == 0 ? found.position[0] : line.project(found.position).along;
    return found;
  }
};

// Fraction of the mass ahead of the front.
inline constexpr double fraction_ahead_of_front = 0.005;

// Search from the foremost particle backwards, in bodies of a given mass [kg].
class FrontSearch {
 public:
  explicit FrontSearch(double mass) : mass_(mass) {}

  // True if the front is at the next particle: the mass behind it is too little.
  [[nodiscard]] bool is_at(double mass_of_next) {
    ahead_ += mass_of_next;
    return mass_ - ahead_ < (1.0 - fraction_ahead_of_front) * mass_;
  }

 private:
  double mass_, ahead_ = 0.0;
};

}  // namespace thawslide::mpm
