#include "sim/maps/path_line.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/state_numbers.hpp"

namespace thawslide::sim {

namespace {

void add_to(BoxOfLine& box, const Point2& point) {
  for (std::size_t a = 0; a < 2; ++a) {
    box.lower[a] = std::min(box.lower[a], point[a]);
    box.upper[a] = std::max(box.upper[a], point[a]);
  }
}

}  // namespace

PathLine::PathLine(const config::Polyline2& corners) {
  for (const Point2& corner : corners) {
    add(corner);
  }
}

void PathLine::add(const Point2& corner) {
  if (corners_.empty()) {
    corners_.push_back(corner);
    along_.push_back(0.0);
    return;
  }
  const double x = corner[0] - corners_.back()[0], y = corner[1] - corners_.back()[1], step = std::hypot(x, y);
  if (step > 0.0) {
    const std::size_t box = directions_.size() / LineView::segments_of_box;
    if (box == boxes_.size()) {
      boxes_.push_back({corners_.back(), corners_.back()});
    }
    add_to(boxes_[box], corners_.back());
    add_to(boxes_[box], corner);
    directions_.push_back({x / step, y / step});
    corners_.push_back(corner);
    along_.push_back(along_.back() + step);
  }
}

void PathLine::remove_last() {
  THAWSLIDE_ASSERT(!empty(), "a line of {} corners", corners_.size());
  corners_.pop_back();
  along_.pop_back();
  directions_.pop_back();
}

void PathLine::reserve(std::size_t corners) {
  corners_.reserve(corners);
  along_.reserve(corners);
  directions_.reserve(corners);
  boxes_.reserve(corners / LineView::segments_of_box + 1);
}

LinePosition PathLine::project(const Point2& point) const {
  THAWSLIDE_ASSERT(!empty(), "a line of {} corners", corners_.size());
  return view().project(point);
}

Point2 PathLine::point_at(double along) const {
  THAWSLIDE_ASSERT(!empty(), "a line of {} corners", corners_.size());
  const auto above = std::upper_bound(along_.begin() + 1, along_.end() - 1, along) - along_.begin();
  const auto k = static_cast<std::size_t>(above) - 1;
  const double fraction = (along - along_[k]) / (along_[k + 1] - along_[k]);
  return {corners_[k][0] + fraction * (corners_[k + 1][0] - corners_[k][0]),
          corners_[k][1] + fraction * (corners_[k + 1][1] - corners_[k][1])};
}

void CentrePath::add_position(const Point2& centre) {
  constexpr double first_sight = 0.01;  // fraction of the spacing that suffices to determine the direction
  if (end_moves()) {
    line_.remove_last();
  }
  const config::Polyline2& corners = line_.corners();
  if (corners.empty()) {
    line_.add(centre);
    return;
  }
  const double moved = std::hypot(centre[0] - corners.back()[0], centre[1] - corners.back()[1]);
  if (moved >= (line_.empty() ? first_sight * spacing_ : spacing_)) {
    line_.add(centre);
  }
}

std::vector<double> CentrePath::state() const {
  std::vector<double> numbers;
  for (const Point2& corner : line_.corners()) {
    numbers.insert(numbers.end(), corner.begin(), corner.end());
  }
  return numbers;
}

void CentrePath::restore(const std::vector<double>& numbers) {
  line_ = PathLine();
  line_.reserve(usual_corners);
  StateNumbers state(numbers, "path of the centre of mass");
  while (state.left() > 0) {
    const double x = state.next_finite(), y = state.next_finite();
    line_.add({x, y});
  }
}

}  // namespace thawslide::sim
