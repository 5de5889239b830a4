// Bodies that touch.

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/nearest_known.hpp"
#include "base/raster_sampling.hpp"
#include "base/rounding.hpp"
#include "gis/point_window.hpp"
#include "gis/release.hpp"

namespace thawslide::gis {

namespace {

using Releases = std::map<std::string, LoadedRelease>;

// Raster accessed by the indices of another layout of the same grid; 0 outside it.
class ByIndicesOf {
 public:
  ByIndicesOf(const Raster& layout, const Raster& raster)
      : raster_(&raster),
        column_(static_cast<int>(std::lround((layout.x - raster.x) / raster.cell_x))),
        row_(static_cast<int>(std::lround((layout.y - raster.y) / raster.cell_y))) {}

  [[nodiscard]] double at(int column, int row) const {
    const int i = column + column_, j = row + row_;
    const bool is_inside = i >= 0 && j >= 0 && i < raster_->columns && j < raster_->rows;
    return is_inside ? raster_->at(i, j) : 0.0;
  }

 private:
  const Raster* raster_;
  int column_, row_;
};

// True if the two lie within a cell of a common point.
bool touch(const LoadedRelease& one, const LoadedRelease& other) {
  const Raster& spread = one.spread;
  const ByIndicesOf there(spread, other.spread);
  const PointWindow shared = points_of(other.spread, spread);
  const int last_column = std::min(spread.columns, shared.first_column + shared.columns + 1);
  const int last_row = std::min(spread.rows, shared.first_row + shared.rows + 1);
  for (int row = std::max(0, shared.first_row - 1); row < last_row; ++row) {
    for (int column = std::max(0, shared.first_column - 1); column < last_column; ++column) {
      for (int k = 0; spread.at(column, row) > 0.0 && k < 9; ++k) {
        if (there.at(column + k % 3 - 1, row + k / 3 - 1) > 0.0) {
          return true;
        }
      }
    }
  }
  return false;
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

// t_b / w_b; outside the body, that of the nearest point.
Raster thickness_within(const LoadedRelease& loaded, const Raster& layout) {
  const ByIndicesOf thickness(layout, loaded.release.thickness), spread(layout, loaded.spread);
  Raster within = layout;
  for_each_point(within, [&](int column, int row, double& value) {
    const double fraction = spread.at(column, row);
    value = fraction > 0.0 ? thickness.at(column, row) / fraction : std::numeric_limits<double>::quiet_NaN();
  });
  fill_from_nearest_known(within);
  return within;
}

double sum_at(const std::vector<ByIndicesOf>& rasters, int column, int row) {
  double sum = 0.0;
  for (const ByIndicesOf& raster : rasters) {
    sum += raster.at(column, row);
  }
  return sum;
}

void join(const config::Case& parameters, const std::string& name, const Releases& releases, config::Release& release) {
  const LoadedRelease& loaded = releases.at(name);
  const Raster layout = widened_layout(parameters, name, loaded.release.thickness);
  std::vector<ByIndicesOf> fractions, spreads;
  for (const auto& [other, one] : releases) {
    fractions.emplace_back(layout, one.fraction);
    spreads.emplace_back(layout, one.spread);
  }
  const ByIndicesOf fraction(layout, loaded.fraction), spread(layout, loaded.spread);
  release.assigned_thickness = thickness_within(loaded, layout);
  release.claim = layout;
  Raster own = layout;
  for (int row = 0; row < layout.rows; ++row) {
    for (int column = 0; column < layout.columns; ++column) {
      const std::size_t k = layout.index(column, row);
      const double all_fractions = sum_at(fractions, column, row), all_spreads = sum_at(spreads, column, row);
      release.assigned_thickness.values[k] *= std::min(1.0, all_spreads);
      release.claim.values[k] = all_fractions > 0.0 ? fraction.at(column, row) : spread.at(column, row);
      const double of_all = all_fractions > 0.0 ? all_fractions : all_spreads;
      own.values[k] =
          release.claim.values[k] > 0.0 ? release.assigned_thickness.values[k] * release.claim.values[k] / of_all : 0.0;
    }
  }
  // Tapers that end at another body move volume between the two; scaling restores the volume of each.
  const double scale = volume_of(loaded.release.thickness) / volume_of(own);
  for (std::size_t k = 0; k < own.values.size(); ++k) {
    own.values[k] *= scale;
    release.assigned_thickness.values[k] *= scale;
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
