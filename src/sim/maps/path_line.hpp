// Line in the horizontal plane along which the travel distance is measured: given, or the path of the centre of mass.
#pragma once

#include <vector>

#include "base/line_view.hpp"
#include "config/site.hpp"

namespace thawslide::sim {

// Polyline with arc lengths. Lines of zero length have no direction and no projection; they become empty.
class PathLine {
 public:
  PathLine() = default;
  // Omits corners that repeat the previous one.
  explicit PathLine(const config::Polyline2& corners);

  [[nodiscard]] bool empty() const { return corners_.size() < 2; }
  [[nodiscard]] double length() const { return along_.back(); }  // [m]; the line must not be empty
  [[nodiscard]] const config::Polyline2& corners() const { return corners_; }
  // Arc length at each corner [m].
  [[nodiscard]] const std::vector<double>& distances() const { return along_; }

  [[nodiscard]] LineView view() const {
    return {corners_.data(), along_.data(), directions_.data(), boxes_.data(), directions_.size()};
  }
  // LineView::project; the line must not be empty.
  [[nodiscard]] LinePosition project(const Point2& point) const;
  [[nodiscard]] Point2 point_at(double along) const;

  // Appends a corner, unless it repeats the last one.
  void add(const Point2& corner);
  void remove_last();
  // Reserves memory for the given number of corners.
  void reserve(std::size_t corners);

 private:
  config::Polyline2 corners_;
  std::vector<double> along_;       // arc length at each corner [m]
  std::vector<Point2> directions_;  // unit vectors from each corner but the last to the next
  std::vector<BoxOfLine> boxes_;    // may be larger than necessary after a corner was removed
};

// Path of a centre of mass. A corner is added when the centre is a spacing [m] away from the last one, so small
// fluctuations do not define the direction. Before the first such corner the path ends at the centre; it is empty while
// the centre is within a hundredth of the spacing of its start.
class CentrePath {
 public:
  explicit CentrePath(double spacing) : spacing_(spacing) { line_.reserve(usual_corners); }

  void add_position(const Point2& centre);
  [[nodiscard]] const PathLine& line() const { return line_; }

  // Corners as numbers; restore() is the inverse.
  [[nodiscard]] std::vector<double> state() const;
  void restore(const std::vector<double>& numbers);

 private:
  static constexpr std::size_t usual_corners = 1024;

  // True while the last corner is provisional, less than a spacing from the first.
  [[nodiscard]] bool end_moves() const { return !line_.empty() && line_.length() < spacing_; }

  double spacing_;
  PathLine line_;
};

}  // namespace thawslide::sim
