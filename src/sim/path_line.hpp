// A line in the horizontal plane along which a slide's way is measured: given, or the way of its centre of mass.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "config/site.hpp"

namespace thawslide::sim {

using Place2 = std::array<double, 2>;  // x, y [m]

// Where a place lies along a line.
struct PlaceOnLine {
  double along = 0.0;   // arc length from the line's first corner [m]; negative before it
  double offset = 0.0;  // distance from the line [m], positive to the left of its direction
};

// Lines of no length have no direction, and nothing can be projected onto them: the line is empty.
class PathLine {
 public:
  PathLine() = default;
  // Corners that repeat the one before are left out.
  explicit PathLine(const config::Polyline2& corners);

  [[nodiscard]] bool empty() const { return corners_.size() < 2; }
  [[nodiscard]] double length() const { return along_.back(); }  // [m]; of a line that is not empty
  [[nodiscard]] const config::Polyline2& corners() const { return corners_; }
  // Arc length at each corner [m].
  [[nodiscard]] const std::vector<double>& distances() const { return along_; }

  // The nearest point of the line, which goes on straight before its first corner and beyond its last one. Of points
  // equally near the one closer to the first corner counts.
  [[nodiscard]] PlaceOnLine project(const Place2& place) const;
  [[nodiscard]] Place2 point_at(double along) const;

  // A further corner, unless it repeats the last one.
  void add(const Place2& corner);
  void remove_last();
  // Makes room for so many corners.
  void reserve(std::size_t corners);

 private:
  // The rectangle about some segments that follow one another: one look tells that none of them is near.
  struct Box {
    Place2 lower, upper;

    void add(const Place2& place);
    [[nodiscard]] double distance2(const Place2& place) const;  // squared [m2]
  };
  static constexpr std::size_t segments_of_box = 8;

  struct Nearest {
    PlaceOnLine place;
    double distance2 = std::numeric_limits<double>::infinity();  // squared [m2]
  };
  void project_onto(std::size_t segment, const Place2& place, Nearest& nearest) const;

  config::Polyline2 corners_;
  std::vector<double> along_;       // arc length at each corner [m]
  std::vector<Place2> directions_;  // unit vectors from each corner but the last to the next
  std::vector<Box> boxes_;          // about so many segments each; larger than need be after a corner was removed
};

// The way of a centre of mass: a corner wherever it is a spacing [m] away from the last one, so that its direction does
// not come from a few millimetres of wavering. Until the first of them the way ends where the centre is, and is empty
// while that is less than a hundredth of the spacing from where it was.
class CentreWay {
 public:
  explicit CentreWay(double spacing) : spacing_(spacing) { line_.reserve(usual_corners); }

  void note(const Place2& centre);
  [[nodiscard]] const PathLine& line() const { return line_; }

  // Its corners, as numbers; and its way back.
  [[nodiscard]] std::vector<double> state() const;
  void restore(const std::vector<double>& numbers);

 private:
  static constexpr std::size_t usual_corners = 1024;

  // Whether the last corner only stands for the first one a spacing away.
  [[nodiscard]] bool end_moves() const { return !line_.empty() && line_.length() < spacing_; }

  double spacing_;
  PathLine line_;
};

}  // namespace thawslide::sim
