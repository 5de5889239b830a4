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

double Polyline::highest(double from, double to) const {
  double top = std::max(height(from), height(to));
  for (auto k = static_cast<std::size_t>(std::upper_bound(x_.begin(), x_.end(), from) - x_.begin());
       k < x_.size() && x_[k] < to; ++k) {
    top = std::max(top, height_[k]);
  }
  return top;
}

Polyline::Nearest Polyline::nearest(double x, double z) const {
  const Vector<double, 2> point(x, z);
  double best = HUGE_VAL;
  Vector<double, 2> foot = point;
  std::size_t at = 0;
  const auto compare = [&](std::size_t k) {
    const Vector<double, 2> a(x_[k], height_[k]);
    const Vector<double, 2> along = Vector<double, 2>(x_[k + 1], height_[k + 1]) - a;
    double t = (point - a).dot(along) / along.squaredNorm();
    // The end segments extend to infinity, each beyond its own end of the line.
    t = std::max(k == 0 ? -HUGE_VAL : 0.0, std::min(k + 2 == x_.size() ? HUGE_VAL : 1.0, t));
    const Vector<double, 2> candidate = a + t * along;
    const double distance = (point - candidate).norm();
    if (distance < best) {
      best = distance;
      foot = candidate;
      at = k;
    }
  };
  // Searches outwards from the segment below, until the horizontal distance alone exceeds the smallest distance found.
  const std::size_t start = segment(x);
  compare(start);
  for (std::size_t k = start; k > 0 && x - x_[k] < best; --k) {
    compare(k - 1);
  }
  for (std::size_t k = start + 1; k + 1 < x_.size() && x_[k] - x < best; ++k) {
    compare(k);
  }
  const double sign = z >= height(x) ? 1.0 : -1.0;
  const double scale = std::max(1.0, std::abs(x) + std::abs(z));
  if (best > 1e-9 * scale) {
    return {sign * best, sign * (foot - point) / best};
  }
  const double slope = (height_[at + 1] - height_[at]) / (x_[at + 1] - x_[at]);
  return {sign * best, Vector<double, 2>(slope, -1.0).normalized()};
}

namespace {

// Linear shape function around 0 on cells of width 1, and its integral from q upwards.
double linear_shape(double q) { return std::max(0.0, 1.0 - std::abs(q)); }

double linear_shape_above(double q) {
  if (q >= 0.0) {
    return q < 1.0 ? 0.5 * (1.0 - q) * (1.0 - q) : 0.0;
  }
  return q > -1.0 ? 1.0 - 0.5 * (1.0 + q) * (1.0 + q) : 1.0;
}

}  // namespace

Polyline::LinearFraction Polyline::linear_fraction(double x, double z, double cell) const {
  // Between these abscissae, the integrands are polynomials of at most third degree, for which three Gauss points are
  // exact.
  std::vector<double> breaks{x - cell, x, x + cell};
  for (std::size_t k = segment(x - cell); k + 1 < x_.size() && (k == 0 || x_[k] < x + cell); ++k) {
    breaks.push_back(x_[k]);
    const double slope = (height_[k + 1] - height_[k]) / (x_[k + 1] - x_[k]);
    for (const double level : {z - cell, z, z + cell}) {
      if (slope != 0.0) {
        breaks.push_back(x_[k] + (level - height_[k]) / slope);
      }
    }
  }
  std::sort(breaks.begin(), breaks.end());
  constexpr double outer = 0.774596669241483377;  // sqrt(3/5)
  LinearFraction fraction;
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    const double from = std::max(breaks[k], x - cell);
    const double to = std::min(breaks[k + 1], x + cell);
    if (to <= from) {
      continue;
    }
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    const double slope = gradient(middle), stretch = std::hypot(1.0, slope), base = height(middle);
    for (const auto& [along, weight] :
         {std::pair(-outer, 5.0 / 9.0), std::pair(0.0, 8.0 / 9.0), std::pair(outer, 5.0 / 9.0)}) {
      const double u = middle + along * half;
      const Vector<double, 2> from_node(u - x, base + slope * (u - middle) - z);
      const double across = weight * half * linear_shape(from_node[0] / cell);
      const double surface = across * linear_shape(from_node[1] / cell);
      fraction.length += stretch * surface;
      fraction.resultant += surface * Vector<double, 2>(slope, -1.0);
      fraction.moment += stretch * surface * from_node;
      fraction.above += across * cell * linear_shape_above(from_node[1] / cell);
    }
  }
  return fraction;
}

// The integrands are polynomials of second degree between the points of the polyline, for which Simpson's rule is
// exact.
double Polyline::steepest(double from, double to) const {
  double found = 0.0;
  for (std::size_t k = segment(from), last = segment(to); k <= last; ++k) {
    found = std::max(found, std::abs((height_[k + 1] - height_[k]) / (x_[k + 1] - x_[k])));
  }
  return found;
}

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
