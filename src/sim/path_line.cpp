#include "sim/path_line.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/state_numbers.hpp"

namespace thawslide::sim {

void PathLine::Box::add(const Place2& place) {
  for (std::size_t a = 0; a < 2; ++a) {
    lower[a] = std::min(lower[a], place[a]);
    upper[a] = std::max(upper[a], place[a]);
  }
}

double PathLine::Box::distance2(const Place2& place) const {
  const double x = std::max({lower[0] - place[0], place[0] - upper[0], 0.0});
  const double y = std::max({lower[1] - place[1], place[1] - upper[1], 0.0});
  return x * x + y * y;
}

PathLine::PathLine(const config::Polyline2& corners) {
  for (const Place2& corner : corners) {
    add(corner);
  }
}

void PathLine::add(const Place2& corner) {
  if (corners_.empty()) {
    corners_.push_back(corner);
    along_.push_back(0.0);
    return;
  }
  const double x = corner[0] - corners_.back()[0], y = corner[1] - corners_.back()[1], step = std::hypot(x, y);
  if (step > 0.0) {
    const std::size_t box = directions_.size() / segments_of_box;
    if (box == boxes_.size()) {
      boxes_.push_back({corners_.back(), corners_.back()});
    }
    boxes_[box].add(corners_.back());
    boxes_[box].add(corner);
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
  boxes_.reserve(corners / segments_of_box + 1);
}

void PathLine::project_onto(std::size_t k, const Place2& place, Nearest& nearest) const {
  const Place2& direction = directions_[k];
  const double x = place[0] - corners_[k][0], y = place[1] - corners_[k][1];
  double along = x * direction[0] + y * direction[1];
  along = k > 0 ? std::max(along, 0.0) : along;
  along = k + 1 < directions_.size() ? std::min(along, along_[k + 1] - along_[k]) : along;
  const double away_x = x - along * direction[0], away_y = y - along * direction[1];
  const double distance2 = away_x * away_x + away_y * away_y;
  along += along_[k];
  if (distance2 < nearest.distance2 || (distance2 == nearest.distance2 && along < nearest.place.along)) {
    nearest.distance2 = distance2;
    nearest.place = {along, std::copysign(std::sqrt(distance2), direction[0] * y - direction[1] * x)};
  }
}

PlaceOnLine PathLine::project(const Place2& place) const {
  THAWSLIDE_ASSERT(!empty(), "a line of {} corners", corners_.size());
  const std::size_t segments = directions_.size();
  Nearest nearest;
  const auto project_onto_box = [&](std::size_t box) {
    const std::size_t first = box * segments_of_box;
    for (std::size_t k = first; k < std::min(first + segments_of_box, segments); ++k) {
      project_onto(k, place, nearest);
    }
  };
  project_onto(0, place, nearest);  // these two go on beyond the boxes
  project_onto(segments - 1, place, nearest);
  const std::size_t boxes = (segments + segments_of_box - 1) / segments_of_box;
  std::size_t closest = 0;
  double least2 = std::numeric_limits<double>::infinity();
  for (std::size_t box = 0; box < boxes; ++box) {
    const double distance2 = boxes_[box].distance2(place);
    if (distance2 < least2) {
      least2 = distance2;
      closest = box;
    }
  }
  project_onto_box(closest);
  for (std::size_t box = 0; box < boxes; ++box) {
    if (box != closest && boxes_[box].distance2(place) <= nearest.distance2) {
      project_onto_box(box);
    }
  }
  return nearest.place;
}

Place2 PathLine::point_at(double along) const {
  THAWSLIDE_ASSERT(!empty(), "a line of {} corners", corners_.size());
  const auto above = std::upper_bound(along_.begin() + 1, along_.end() - 1, along) - along_.begin();
  const auto k = static_cast<std::size_t>(above) - 1;
  const double share = (along - along_[k]) / (along_[k + 1] - along_[k]);
  return {corners_[k][0] + share * (corners_[k + 1][0] - corners_[k][0]),
          corners_[k][1] + share * (corners_[k + 1][1] - corners_[k][1])};
}

void CentreWay::note(const Place2& centre) {
  constexpr double first_sight = 0.01;  // of the spacing: enough to tell the direction
  if (end_moves()) {
    line_.remove_last();
  }
  const config::Polyline2& corners = line_.corners();
  if (corners.empty()) {
    line_.add(centre);
    return;
  }
  const double gone = std::hypot(centre[0] - corners.back()[0], centre[1] - corners.back()[1]);
  if (gone >= (line_.empty() ? first_sight * spacing_ : spacing_)) {
    line_.add(centre);
  }
}

std::vector<double> CentreWay::state() const {
  std::vector<double> numbers;
  for (const Place2& corner : line_.corners()) {
    numbers.insert(numbers.end(), corner.begin(), corner.end());
  }
  return numbers;
}

void CentreWay::restore(const std::vector<double>& numbers) {
  line_ = PathLine();
  line_.reserve(usual_corners);
  StateNumbers state(numbers, "way of the centre of mass");
  while (state.left() > 0) {
    const double x = state.next_finite(), y = state.next_finite();
    line_.add({x, y});
  }
}

}  // namespace thawslide::sim
