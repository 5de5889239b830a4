// Shape of a body at t = 0.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "config/case.hpp"
#include "config/site.hpp"
#include "sim/setup/release_body.hpp"

namespace thawslide::sim {

// Space filled by a body: point membership and elevation of its top.
template <int Dim>
class BodyShape {
 public:
  // release: for a body of that shape.
  BodyShape(const config::Case& parameters, const config::Site& site, const config::Body& body,
            std::optional<ReleaseBody> release)
      : body_(&body), tie_(1e-9 * parameters.grid.cell), release_(std::move(release)) {
    for (std::size_t a = 0; a < Dim; ++a) {
      lower_[a] = body.min[a];
      upper_[a] = body.max[a];
    }
    if (body.shape == config::BodyShape::polygon) {
      lower_.fill(std::numeric_limits<double>::infinity());
      upper_.fill(-std::numeric_limits<double>::infinity());
      for (const auto& vertex : body.vertices) {
        for (std::size_t a = 0; a < 2; ++a) {
          lower_[a] = std::min(lower_[a], vertex[a]);
          upper_[a] = std::max(upper_[a], vertex[a]);
        }
      }
    } else if (body.shape == config::BodyShape::surface) {
      profile_ = config::profile_of(parameters, site);
      limit_to_profile();
    }
  }

  [[nodiscard]] double lower(std::size_t axis) const { return lower_[axis]; }
  [[nodiscard]] double upper(std::size_t axis) const { return upper_[axis]; }

  [[nodiscard]] const std::optional<ReleaseBody>& release() const { return release_; }

  [[nodiscard]] bool contains(const Vector<double, Dim>& point) const {
    if constexpr (Dim == 3) {
      if (release_) {
        return release_->contains(point);
      }
    }
    for (std::size_t a = 0; a < Dim; ++a) {
      if (point[static_cast<int>(a)] < lower_[a] || point[static_cast<int>(a)] > upper_[a]) {
        return false;
      }
    }
    // A centre on an inclined side, to within round-off, is inside if the body lies above that side.
    const double height = point[Dim - 1] + tie_;
    switch (body_->shape) {
      case config::BodyShape::box:
        return true;
      case config::BodyShape::polygon:
        return crossings_above(point[0], height) % 2 == 1;
      case config::BodyShape::surface:
      case config::BodyShape::release:
        break;
    }
    return height > profile_at(profile_.terrain, point[0]) && height < top(point[0], point[Dim - 1]);
  }

  // Area of the section [m2]; in 3D, times the width [m3].
  [[nodiscard]] double volume() const {
    const double width = Dim == 2 ? 1.0 : upper_[1] - lower_[1];
    double area = 0.0;
    switch (body_->shape) {
      case config::BodyShape::box:
        return width * (upper_[0] - lower_[0]) * (upper_[Dim - 1] - lower_[Dim - 1]);
      case config::BodyShape::polygon: {
        const auto& v = body_->vertices;
        for (std::size_t k = 0; k < v.size(); ++k) {
          const auto& next = v[(k + 1) % v.size()];
          area += 0.5 * (v[k][0] - v[0][0]) * (next[1] - v[0][1]) - 0.5 * (next[0] - v[0][0]) * (v[k][1] - v[0][1]);
        }
        return width * std::abs(area);
      }
      case config::BodyShape::release:
        return release_.value().volume();
      case config::BodyShape::surface:
        break;
    }
    const auto& x = profile_.distance;
    for (std::size_t k = 0; k + 1 < x.size(); ++k) {
      area += 0.5 * (x[k + 1] - x[k]) *
              (profile_.surface[k] - profile_.terrain[k] + profile_.surface[k + 1] - profile_.terrain[k + 1]);
    }
    return width * area;
  }

  // Elevation of the body's top above a point in it.
  [[nodiscard]] double top(double x, double height) const {
    switch (body_->shape) {
      case config::BodyShape::box:
        return upper_[Dim - 1];
      case config::BodyShape::polygon: {
        double highest = height;
        for_crossings(x, [&](double z) { highest = std::max(highest, z); });
        return highest;
      }
      case config::BodyShape::surface:
      case config::BodyShape::release:
        break;
    }
    return profile_at(profile_.surface, x);
  }

  // Bottom and top [m] of the parts of the body over x, between its first and last x; not of releases.
  [[nodiscard]] std::vector<std::pair<double, double>> parts_over(double x) const {
    std::vector<double> ends;
    switch (body_->shape) {
      case config::BodyShape::box:
        ends = {lower_[Dim - 1], upper_[Dim - 1]};
        break;
      case config::BodyShape::polygon:
        for_crossings(x, [&](double z) { ends.push_back(z); });
        std::sort(ends.begin(), ends.end());
        break;
      case config::BodyShape::surface:
      case config::BodyShape::release:
        ends = {profile_at(profile_.terrain, x), profile_at(profile_.surface, x)};
        break;
    }
    std::vector<std::pair<double, double>> parts;
    for (std::size_t k = 0; k + 1 < ends.size(); k += 2) {
      parts.emplace_back(ends[k], ends[k + 1]);
    }
    return parts;
  }

 private:
  void limit_to_profile() {
    lower_[0] = std::numeric_limits<double>::infinity();
    upper_[0] = -lower_[0];
    lower_[Dim - 1] = std::numeric_limits<double>::infinity();
    upper_[Dim - 1] = -lower_[Dim - 1];
    for (std::size_t k = 0; k < profile_.distance.size(); ++k) {
      if (profile_.surface[k] > profile_.terrain[k]) {
        lower_[0] = std::min(lower_[0], profile_.distance[k == 0 ? 0 : k - 1]);
        upper_[0] = std::max(upper_[0], profile_.distance[std::min(k + 1, profile_.distance.size() - 1)]);
        lower_[Dim - 1] = std::min(lower_[Dim - 1], profile_.terrain[std::min(k + 1, profile_.distance.size() - 1)]);
        lower_[Dim - 1] = std::min(lower_[Dim - 1], profile_.terrain[k == 0 ? 0 : k - 1]);
        upper_[Dim - 1] = std::max(upper_[Dim - 1], profile_.surface[k]);
      }
    }
  }

  [[nodiscard]] double profile_at(const std::vector<double>& column, double x) const {
    return Table{profile_.distance, column}.at(x);
  }

  template <class Visit>
  void for_crossings(double x, const Visit& visit) const {
    const auto& v = body_->vertices;
    for (std::size_t k = 0; k < v.size(); ++k) {
      const auto& a = v[k];
      const auto& b = v[(k + 1) % v.size()];
      if ((a[0] <= x) != (b[0] <= x)) {
        visit(a[1] + (x - a[0]) / (b[0] - a[0]) * (b[1] - a[1]));
      }
    }
  }

  [[nodiscard]] int crossings_above(double x, double height) const {
    int count = 0;
    for_crossings(x, [&](double z) { count += z > height ? 1 : 0; });
    return count;
  }

  const config::Body* body_;
  double tie_;
  std::optional<ReleaseBody> release_;
  config::ProfileTable profile_;
  std::array<double, Dim> lower_{}, upper_{};
};

}  // namespace thawslide::sim
