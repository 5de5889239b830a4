#include "terrain/polyline.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace thawslide::terrain {

Polyline::Polyline(std::vector<double> x, std::vector<double> height) : x_(std::move(x)), height_(std::move(height)) {
  THAWSLIDE_ASSERT(x_.size() >= 2 && x_.size() == height_.size(), "{} abscissae, {} heights", x_.size(),
                   height_.size());
  for (std::size_t k = 1; k < x_.size(); ++k) {
    THAWSLIDE_ASSERT(x_[k] > x_[k - 1], "abscissae {} and {} do not ascend", x_[k - 1], x_[k]);
  }
}

std::size_t Polyline::segment(double x) const {
  const auto after = std::upper_bound(x_.begin() + 1, x_.end() - 1, x);
  return static_cast<std::size_t>(after - x_.begin()) - 1;
}

double Polyline::gradient(double x) const {
  const std::size_t k = segment(x);
  return (height_[k + 1] - height_[k]) / (x_[k + 1] - x_[k]);
}

double Polyline::height(double x) const {
  const std::size_t k = segment(x);
  return height_[k] + (x - x_[k]) * (height_[k + 1] - height_[k]) / (x_[k + 1] - x_[k]);
}

double Polyline::steepest(double from, double to) const {
  double found = 0.0;
  for (std::size_t k = segment(from), last = segment(to); k <= last; ++k) {
    found = std::max(found, std::abs((height_[k + 1] - height_[k]) / (x_[k + 1] - x_[k])));
  }
  return found;
}

// The integrands are polynomials of second degree between the points of the polyline, for which Simpson's rule is
// exact.
Polyline::HatMeans Polyline::hat_means(double x, double cell) const {
  HatMeans means;
  const auto add_half = [&](double begin, double end) {
    double from = begin;
    for (std::size_t k = segment(from); from < end; ++k) {
      const double to = k + 2 < x_.size() ? std::min(end, std::max(from, x_[k + 1])) : end;
      const double middle = 0.5 * (from + to);
      const double slope = gradient(middle), base = height(middle);
      for (const auto& [u, weight] :
           {std::pair(from, 1.0 / 6.0), std::pair(middle, 4.0 / 6.0), std::pair(to, 1.0 / 6.0)}) {
        const double hat = weight * (to - from) / cell * std::max(0.0, 1.0 - std::abs(u - x) / cell);
        means.height += hat * (base + slope * (u - middle));
        means.length += hat * std::hypot(1.0, slope);
      }
      from = to;
    }
  };
  add_half(x - cell, x);
  add_half(x, x + cell);
  return means;
}

}  // namespace thawslide::terrain
