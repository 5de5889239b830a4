// Direction along a line in which bodies leave, from their initial momentum and from gravity along the ground below.
#pragma once

#include <algorithm>
#include <cmath>

namespace thawslide::sim {

inline constexpr double least_sum = 1e-6;  // of the maximum momentum or force: smaller values are round-off

// Momentum and force along a direction, with their magnitudes if fully aligned with it.
class Departure {
 public:
  void add_momentum(double mass, double along, double speed) {
    mass_ += mass;
    momentum_ += mass * along;
    most_momentum_ += mass * speed;
  }
  // slope: dz/de; g_e and g_z: gravity along e and downwards.
  void add_force(double mass, double slope, double g_e, double g_z) {
    force_ += mass * (g_e - g_z * slope) / std::hypot(1.0, slope);
    most_force_ += mass * std::hypot(g_e, g_z);
  }
  // Returns 0 if there is no direction. length: of all bodies together, along the direction [m].
  [[nodiscard]] int direction(double length) const {
    const int moving = sign_of(momentum_, most_momentum_), pulled = sign_of(force_, most_force_);
    const bool turns_back = moving * pulled < 0 && momentum_ * momentum_ <= mass_ * std::abs(force_) * length;
    return moving != 0 && !turns_back ? moving : pulled;
  }

 private:
  static int sign_of(double sum, double most) { return std::abs(sum) <= least_sum * most ? 0 : sum > 0.0 ? 1 : -1; }

  double mass_ = 0.0, momentum_ = 0.0, most_momentum_ = 0.0, force_ = 0.0, most_force_ = 0.0;
};

// Extent of the bodies along an axis [m].
class Extent {
 public:
  void add(double point, double half) {
    least_ = std::min(least_, point - half);
    greatest_ = std::max(greatest_, point + half);
  }
  [[nodiscard]] double length() const { return std::max(0.0, greatest_ - least_); }

 private:
  double least_ = HUGE_VAL, greatest_ = -HUGE_VAL;
};

}  // namespace thawslide::sim
