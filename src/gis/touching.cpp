// Bodies that touch.

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/raster.hpp"
#include "base/rounding.hpp"
#include "gis/point_window.hpp"
#include "gis/release.hpp"

namespace thawslide::gis {

namespace {

using Releases = std::map<std::string, LoadedRelease>;

// Values of a raster at the points of a layout of the same grid; 0 outside it.
Raster placed(const Raster& raster, const Raster& layout) {
  const auto column_of_first = static_cast<int>(std::lround((raster.x - layout.x) / raster.cell_x));
  const auto row_of_first = static_cast<int>(std::lround((raster.y - layout.y) / raster.cell_y));
  Raster result = layout.filled(0.0);
  for_each_point(result, [&](int column, int row, double& value) {
    const int i = column - column_of_first, j = row - row_of_first;
    value = i >= 0 && j >= 0 && i < raster.columns && j < raster.rows ? raster.at(i, j) : 0.0;
  });
  return result;
}

// True if the two lie within a cell of a common point.
bool touch(const LoadedRelease& one, const LoadedRelease& other) {
  const Raster& spread = one.spread;
  const Raster there = placed(other.spread, layout_of(spread, {-1, -1, spread.columns + 2, spread.rows + 2}));
  bool found = false;
  for_each_point(spread, [&](int column, int row, double value) {
    for (int k = 0; value > 0.0 && k < 9; ++k) {
      found = found || there.at(column + k % 3, row + k / 3) > 0.0;
    }
  });
  return found;
}

std::set<std::string> touching_ones(const config::Case& parameters, const Releases& releases) {
  std::set<std::string> found;
  for (auto second = releases.begin(); second != releases.end(); ++second) {
    for (auto first = releases.begin(); first != second; ++first) {
      if (!touch(first->second, second->second)) {
        continue;
      }
      const double one = parameters.bodies.at(first->first).taper, other = parameters.bodies.at(second->first).taper;
      if (one != other) {
        throw UserError(
            "{}: the bodies '{}' and '{}' touch, or lie in one another's taper, and their tapers differ: {:g} m and "
            "{:g} m; allowed: the same. Set both keys to one value.",
            place_of(parameters, fmt::format("body.{}.taper", second->first)), first->first, second->first, one, other);
      }
      found.insert({first->first, second->first});
    }
  }
  return found;
}

// Layout with additional points on each side, within the reach of a column of particles.
Raster widened_layout(const config::Case& parameters, const std::string& name, const Raster& thickness) {
  const double reach = 0.5 * parameters.grid.cell / parameters.bodies.at(name).particles_per_axis;
  const int columns = 2 + static_cast<int>(std::ceil(reach / thickness.cell_x));
  const int rows = 2 + static_cast<int>(std::ceil(reach / thickness.cell_y));
  const Raster layout =
      layout_of(thickness, {-columns, -rows, thickness.columns + 2 * columns, thickness.rows + 2 * rows});
  return layout.filled(0.0);
}

void join(const config::Case& parameters, const std::string& name, const Releases& releases, config::Release& release) {
  const LoadedRelease& loaded = releases.at(name);
  const Raster layout = widened_layout(parameters, name, loaded.release.thickness);
  Raster all_fractions = layout, all_spreads = layout;
  for (const auto& [other, one] : releases) {
    const Raster more_fractions = placed(one.fraction, layout), more_spreads = placed(one.spread, layout);
    for (std::size_t k = 0; k < layout.values.size(); ++k) {
      all_fractions.values[k] += more_fractions.values[k];
      all_spreads.values[k] += more_spreads.values[k];
    }
  }
  const Raster fraction = placed(loaded.fraction, layout), spread = placed(loaded.spread, layout);
  // t_b / w_b; outside the body, that of the nearest point.
  Raster& assigned = release.assigned_thickness = placed(loaded.release.thickness, layout);
  for (std::size_t k = 0; k < assigned.values.size(); ++k) {
    assigned.values[k] =
        spread.values[k] > 0.0 ? assigned.values[k] / spread.values[k] : std::numeric_limits<double>::quiet_NaN();
  }
  fill_from_nearest_known(assigned);
  release.claim = layout;
  Raster own = layout;
  for (std::size_t k = 0; k < own.values.size(); ++k) {
    const bool is_within = all_fractions.values[k] > 0.0;
    assigned.values[k] *= std::min(1.0, all_spreads.values[k]);
    release.claim.values[k] = is_within ? fraction.values[k] : spread.values[k];
    const double of_all = is_within ? all_fractions.values[k] : all_spreads.values[k];
    own.values[k] = release.claim.values[k] > 0.0 ? assigned.values[k] * release.claim.values[k] / of_all : 0.0;
  }
  // Tapers that end at another body move volume between the two; scaling restores the volume of each.
  const double scale = volume_of(loaded.release.thickness) / volume_of(own);
  for (std::size_t k = 0; k < own.values.size(); ++k) {
    own.values[k] *= scale;
    assigned.values[k] *= scale;
  }
  release.thickness = part_of(own, points_of(loaded.release.thickness, own));
}

}  // namespace

void check_overlaps(const config::Case& parameters, const Releases& releases) {
  for (auto second = releases.begin(); second != releases.end(); ++second) {
    for (auto first = releases.begin(); first != second; ++first) {
      if (const auto shared = overlap_of(first->second.polygons, second->second.polygons)) {
        const char* const key = parameters.bodies.at(second->first).release.empty() ? "thickness" : "release";
        throw UserError(
            "{}: the bodies '{}' and '{}' overlap by {} m2 about {}; allowed: bodies that touch or lie apart, but for "
            "slivers up to {} m2, {:g} % of the smaller one. Draw them apart (QGIS: Vector > Geoprocessing Tools > "
            "Difference).",
            place_of(parameters, fmt::format("body.{}.{}", second->first, key)), first->first, second->first,
            rounded_text(shared->area, 3), shared->place, rounded_text(shared->allowed, 3), 100.0 * overlap_tolerance);
      }
    }
  }
}

void join_touching(const config::Case& parameters, Releases& releases) {
  std::map<std::string, config::Release> joined;
  for (const std::string& name : touching_ones(parameters, releases)) {
    joined[name] = releases.at(name).release;
    join(parameters, name, releases, joined[name]);
  }
  for (auto& [name, release] : joined) {
    releases.at(name).release = std::move(release);
  }
}

}  // namespace thawslide::gis
