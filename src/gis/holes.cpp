#include "gis/holes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/raster_sampling.hpp"
#include "gis/error_location.hpp"

namespace thawslide::gis {

namespace {

// Distance to the nearest release, each represented by its bounding rectangle [m].
double distance_to_releases(const config::Site& site, double x, double y) {
  double least = HUGE_VAL;
  for (const auto& [name, release] : site.releases) {
    const Raster& area = release.thickness;
    const double along_x = std::max({0.0, area.x - x, x - area.x_end()});
    const double along_y = std::max({0.0, area.y - y, y - area.y_end()});
    least = std::min(least, std::hypot(along_x, along_y));
  }
  return least;
}

}  // namespace

std::vector<std::string> probes_in_holes(const config::Site& site) {
  const Raster& ground = *site.ground;
  std::vector<std::string> warnings;
  for (const auto& [name, corners] : site.probes) {
    const bool is_known = std::any_of(corners.begin(), corners.end(), [&](const auto& corner) {
      return !std::isnan(bilinear(ground, corner[0], corner[1], Missing::unknown));
    });
    if (!is_known) {
      warnings.push_back(fmt::format(
          "probe.{}: the DEM has no data there, and the probe reports zeros. Move it to where the terrain is known.",
          name));
    }
  }
  return warnings;
}

std::string holes_warning(const config::Case& parameters, const config::Site& site) {
  const Raster& ground = *site.ground;
  const Rectangle domain = domain_of(parameters);
  std::size_t points = 0, unknown = 0;
  double nearest = HUGE_VAL, nearest_x = 0.0, nearest_y = 0.0;
  for (int row = 0; row < ground.rows; ++row) {
    for (int column = 0; column < ground.columns; ++column) {
      const double x = ground.x_of(column), y = ground.y_of(row);
      if (!domain.contains(x, y)) {
        continue;
      }
      ++points;
      if (!std::isnan(ground.at(column, row))) {
        continue;
      }
      const double distance = distance_to_releases(site, x, y);
      if (unknown++ == 0 || distance < nearest) {
        nearest = distance;
        nearest_x = x;
        nearest_y = y;
      }
    }
  }
  if (unknown == 0) {
    return "";
  }
  const std::string from = site.releases.empty() ? "" : fmt::format(", about {:.0f} m from the release", nearest);
  return fmt::format(
      "{} of {} points of the DEM within the domain have no data, the nearest at ({:.0f}, {:.0f}){}: a slide that gets "
      "there {}",
      unknown, points, nearest_x, nearest_y, from,
      parameters.grid.leaving == config::Policy::remove ? "is removed and counted" : "ends the run");
}

}  // namespace thawslide::gis
