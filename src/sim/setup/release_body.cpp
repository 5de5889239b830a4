#include "sim/setup/release_body.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/rounding.hpp"
#include "config/body_layers.hpp"

namespace thawslide::sim {

namespace {

constexpr double thinnest = 0.1;  // particle height relative to the particle spacing

// Even-odd rule: parity of the ring sides crossed by a ray to the east.
bool is_within(const std::vector<config::Polyline2>& rings, double x, double y) {
  bool within = false;
  for (const config::Polyline2& ring : rings) {
    for (std::size_t k = 0; k + 1 < ring.size(); ++k) {
      const auto& low = ring[k][1] <= ring[k + 1][1] ? ring[k] : ring[k + 1];
      const auto& high = ring[k][1] <= ring[k + 1][1] ? ring[k + 1] : ring[k];
      if (low[1] <= y && y < high[1] && x < low[0] + (y - low[1]) / (high[1] - low[1]) * (high[0] - low[0])) {
        within = !within;
      }
    }
  }
  return within;
}

// Claim of a release to a place near it: its outline takes precedence over every fraction.
double claim_of(const config::Release& release, double x, double y) {
  constexpr double within_outline = 2.0;
  return is_within(release.outlines, x, y) ? within_outline : bilinear(release.claim, x, y, Missing::zero);
}

}  // namespace

double nearest_value(const Raster& raster, double x, double y) {
  constexpr int reach = 2;  // points on each side
  const int column = static_cast<int>(std::lround((x - raster.x) / raster.cell_x));
  const int row = static_cast<int>(std::lround((y - raster.y) / raster.cell_y));
  double value = std::nan(""), least = HUGE_VAL;
  for (int j = std::max(0, row - reach); j <= std::min(raster.rows - 1, row + reach); ++j) {
    for (int i = std::max(0, column - reach); i <= std::min(raster.columns - 1, column + reach); ++i) {
      const double distance = std::hypot(raster.x_of(i) - x, raster.y_of(j) - y);
      if (!std::isnan(raster.at(i, j)) && distance < least) {
        least = distance;
        value = raster.at(i, j);
      }
    }
  }
  if (std::isnan(value)) {
    throw UserError(
        fmt::format("a map of an initial field has no value at x = {} m, y = {} m, where the release is; give one that "
                    "covers the whole release.",
                    coordinate_text(x), coordinate_text(y)));
  }
  return value;
}

config::Polyline2 corners_of(const config::Release& release) {
  config::Polyline2 corners;
  for (const config::Polyline2& ring : release.outlines) {
    corners.insert(corners.end(), ring.begin(), ring.end());
  }
  const Raster& t = release.thickness;
  const auto add_cell = [&](int column, int row) {
    for (const double i : {-0.5, 0.5}) {
      for (const double j : {-0.5, 0.5}) {
        corners.push_back({t.x + (column + i) * t.cell_x, t.y + (row + j) * t.cell_y});
      }
    }
  };
  if (release.outlines.empty()) {
    config::for_points_of_release(t, add_cell);
  }
  return corners;
}

double top_of(const config::Release& release, const Raster& ground) {
  const Raster& thickness = release.thickness;
  double top = -HUGE_VAL;
  config::for_points_of_release(thickness, [&](int column, int row) {
    const double height = bilinear(ground, thickness.x_of(column), thickness.y_of(row), Missing::nothing);
    top = std::fmax(top, height + thickness.at(column, row));
  });
  return top;
}

double ReleaseBody::bottom(double x, double y) const {
  return ground_->height(Vector<double, 2>(x - origin_[0], y - origin_[1])) + origin_[2];
}

bool ReleaseBody::contains(const Vector<double, 3>& point) const {
  const double here = bilinear(thickness(), point[0], point[1], Missing::zero);
  const double above = point[2] - bottom(point[0], point[1]);
  return above > 0.0 && above < here && owns(point[0], point[1]);
}

bool ReleaseBody::owns(double x, double y) const {
  if (release_->claim.empty()) {
    return true;
  }
  const double claim = claim_of(*release_, x, y);
  bool is_later = false;  // if claims are equal, the first body takes the place
  for (const auto& [name, other] : *releases_) {
    is_later = is_later || &other == release_;
    if (&other == release_ || other.claim.empty() || bilinear(other.claim, x, y, Missing::zero) == 0.0) {
      continue;
    }
    const double rival = claim_of(other, x, y);
    if (rival > claim || (rival == claim && !is_later)) {
      return false;
    }
  }
  return claim > 0.0;
}

// Midpoint rule, finer than the raster spacing.
double ReleaseBody::mean_thickness(double x, double y, double width) const {
  const Raster& t = thickness();
  const double finest = std::min(t.cell_x, t.cell_y);
  const int parts = 1 + 2 * static_cast<int>(std::ceil(width / finest));
  double sum = 0.0;
  for (int j = 0; j < parts; ++j) {
    for (int i = 0; i < parts; ++i) {
      sum += bilinear(t, x + width * ((i + 0.5) / parts - 0.5), y + width * ((j + 0.5) / parts - 0.5), Missing::zero);
    }
  }
  return sum / (parts * parts);
}

void ReleaseBody::seed(const Vector<double, 3>& corner, double spacing, int body, std::vector<Seed<3>>& seeds) const {
  const auto number = [&](double point, int axis) {
    return static_cast<long>(std::floor((point - corner[axis]) / spacing));
  };
  const Raster& t = thickness();
  const long first_column = number(t.x - t.cell_x, 0), last_column = number(t.x_end() + t.cell_x, 0);
  const long first_row = number(t.y - t.cell_y, 1), last_row = number(t.y_end() + t.cell_y, 1);
  for (long j = first_row; j <= last_row; ++j) {
    for (long i = first_column; i <= last_column; ++i) {
      const double x = corner[0] + (static_cast<double>(i) + 0.5) * spacing;
      const double y = corner[1] + (static_cast<double>(j) + 0.5) * spacing;
      if (!owns(x, y)) {
        continue;
      }
      const double thickness = mean_thickness(x, y, spacing);
      const long fitting = std::lround(thickness / spacing);
      // True if the release itself is thin, not if it only extends into the column.
      const bool is_thin = fitting == 0 && thickness >= thinnest * spacing && bilinear(t, x, y, Missing::zero) > 0.0;
      const long count = is_thin ? 1 : fitting;
      const double low = count > 0 ? bottom(x, y) : 0.0;
      for (long k = 0; k < count; ++k) {
        const double height = (static_cast<double>(k) + 0.5) / static_cast<double>(count) * thickness;
        const std::array<std::uint32_t, 3> lattice{static_cast<std::uint32_t>(i - first_column),
                                                   static_cast<std::uint32_t>(j - first_row),
                                                   static_cast<std::uint32_t>(k)};
        seeds.push_back({body, Vector<double, 3>(x, y, low + height), thickness - height,
                         thickness / static_cast<double>(count) * spacing * spacing, lattice});
      }
    }
  }
}

std::vector<double> release_times(const config::Case& parameters, const config::Site& site, std::size_t bodies) {
  if (!config::has_stages(parameters)) {
    return {};
  }
  std::vector<double> times(bodies, 0.0);
  std::size_t number = 0;
  for (const auto& [name, body] : parameters.bodies) {
    double& time = times[number++];
    time = body.release_time.number;
    if (!body.release_time.attribute.empty()) {
      const auto release = site.releases.find(name);
      THAWSLIDE_ASSERT(release != site.releases.end(), "body.{} has a release time of polygons, and no release", name);
      time = release->second.release_time;
    }
  }
  const bool all_at_once = std::all_of(times.begin(), times.end(), [](double time) { return time == 0.0; });
  return all_at_once ? std::vector<double>{} : times;
}

bool is_held(const std::vector<double>& times, double time, std::size_t body) {
  return !times.empty() && time < times[body] * (1.0 - round_off);
}

double next_release(const std::vector<double>& times, double time) {
  double next = HUGE_VAL;
  for (std::size_t body = 0; body < times.size(); ++body) {
    next = is_held(times, time, body) ? std::min(next, times[body]) : next;
  }
  return next;
}

}  // namespace thawslide::sim
