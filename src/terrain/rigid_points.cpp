#include "terrain/rigid_points.hpp"

#include <algorithm>
#include <cmath>

namespace thawslide::terrain {

RigidPoints::RigidPoints(const Polyline& line, double spacing, int layers)
    : line_(&line), spacing_(spacing), layers_(layers) {}

bool RigidPoints::is_rock(long column, long row) const {
  constexpr double round_off = 1e-9;
  const double depth = line_->height((static_cast<double>(column) + 0.5) * spacing_) / spacing_ -
                       (static_cast<double>(row) + 0.5);  // depth of the point's centre, in squares
  return depth > round_off && depth < static_cast<double>(layers_);
}

RigidPoints::AtNode RigidPoints::at_node(double x, double z, double cell) const {
  const auto first = [&](double centre) { return static_cast<long>(std::floor((centre - cell) / spacing_)); };
  const auto last = [&](double centre) { return static_cast<long>(std::ceil((centre + cell) / spacing_)); };
  AtNode node{0.0, Vector<double, 2>::Zero()};
  for (long i = first(x); i <= last(x); ++i) {
    const double across = ((static_cast<double>(i) + 0.5) * spacing_ - x) / cell;
    if (std::abs(across) >= 1.0) {
      continue;
    }
    for (long j = first(z); j <= last(z); ++j) {
      const double up = ((static_cast<double>(j) + 0.5) * spacing_ - z) / cell;
      if (std::abs(up) >= 1.0 || !is_rock(i, j)) {
        continue;
      }
      const double point = spacing_ * spacing_;
      node.volume += point * (1.0 - std::abs(across)) * (1.0 - std::abs(up));
      // Minus grad S at the point; S decreases away from the node.
      node.normal +=
          point / cell *
          Vector<double, 2>(std::copysign(1.0 - std::abs(up), across), std::copysign(1.0 - std::abs(across), up));
    }
  }
  node.normal = node.normal.norm() > 0.0 ? node.normal.normalized() : Vector<double, 2>(0.0, -1.0);
  return node;
}

double nairn_area(double slide_volume, double rock_volume, double cell) {
  return std::sqrt(2.0 * std::min(slide_volume, rock_volume) * (slide_volume + rock_volume)) / cell;
}

}  // namespace thawslide::terrain
