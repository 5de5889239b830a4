// Rectangle in the horizontal plane.
#pragma once

#include <algorithm>

namespace thawslide::gis {

struct Rectangle {
  double min_x = 0.0, min_y = 0.0, max_x = 0.0, max_y = 0.0;  // [m], or degrees in a geographic reference system

  [[nodiscard]] bool contains(double x, double y) const { return x >= min_x && x <= max_x && y >= min_y && y <= max_y; }
  [[nodiscard]] bool contains(const Rectangle& other) const {
    return contains(other.min_x, other.min_y) && contains(other.max_x, other.max_y);
  }
  [[nodiscard]] bool touches(const Rectangle& other) const {
    return min_x <= other.max_x && other.min_x <= max_x && min_y <= other.max_y && other.min_y <= max_y;
  }
  [[nodiscard]] Rectangle widened(double along_x, double along_y) const {
    return {min_x - along_x, min_y - along_y, max_x + along_x, max_y + along_y};
  }
  void include(double x, double y) {
    min_x = std::min(min_x, x);
    max_x = std::max(max_x, x);
    min_y = std::min(min_y, y);
    max_y = std::max(max_y, y);
  }
};

}  // namespace thawslide::gis
