// A line in the horizontal plane along which a slide's way is measured: given, or the way of its centre of mass.
#pragma once

#include <vector>

#include "base/line_view.hpp"
#include "config/site.hpp"

namespace thawslide::sim {

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

  [[nodiscard]] LineView view() const {
    return {corners_.data(), along_.data(), directions_.data(), boxes_.data(), directions_.size()};
  }
  // LineView::project, onto a line that is not empty.
  [[nodiscard]] PlaceOnLine project(const Place2& place) const;
  [[nodiscard]] Place2 point_at(double along) const;

  // A further corner, unless it repeats the last one.
  void add(const Place2& corner);
  void remove_last();
  // Makes room for so many corners.
  void reserve(std::size_t corners);

 private:
  config::Polyline2 corners_;
  std::vector<double> along_;       // arc length at each corner [m]
  std::vector<Place2> directions_;  // unit vectors from each corner but the last to the next
  std::vector<BoxOfLine> boxes_;    // larger than need be after a corner was removed
};

// The way of a centre of mass: a corner wherever it is a spacing [m] away from the last one, so that its direction does
// not come from a few millimetres of wavering. Until the first of them the way ends where the centre is, and is empty
// while that is less than a hundredth of the spacing from where it was.
class CentrePath {
 public:
  explicit CentrePath(double spacing) : spacing_(spacing) { line_.reserve(usual_corners); }

  void add_position(const Place2& centre);
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
