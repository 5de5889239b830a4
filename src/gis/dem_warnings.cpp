#include "gis/dem_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "base/raster_sampling.hpp"
#include "base/text.hpp"
#include "gis/case_inputs.hpp"

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

constexpr double least_step = 100.0;           // m
constexpr double steep = 5.67128181961770953;  // tan(80 degrees)

// Patches of points with one value, separated by cliffs from the surrounding ground.
struct Apart {
  std::size_t points = 0;
  double x = 0.0, y = 0.0;                        // of one of the points [m]
  double lowest = HUGE_VAL, highest = -HUGE_VAL;  // of the adjacent ground [m]
};

struct Cell {
  int column = 0, row = 0;
};

bool is_cliff(double one, double other, double distance) {
  return std::abs(one - other) > std::max(least_step, steep * distance);
}

// Calls work(cell, distance) for the known neighbours of a point.
template <class Work>
void for_each_neighbour(const Raster& ground, const Cell& cell, const Work& work) {
  constexpr std::array<Cell, 4> directions{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
  for (const Cell& direction : directions) {
    const int column = cell.column + direction.column, row = cell.row + direction.row;
    const bool inside = column >= 0 && column < ground.columns && row >= 0 && row < ground.rows;
    if (inside && !std::isnan(ground.at(column, row))) {
      work(Cell{column, row}, direction.row == 0 ? ground.cell_x : ground.cell_y);
    }
  }
}

// Patch of all points of the same value connected to one; nothing if its surrounding ground is not all cliffs.
std::optional<Apart> patch_at(const Raster& ground, const Cell& first, std::vector<char>& seen) {
  const double height = ground.at(first.column, first.row);
  Apart patch{.x = ground.x_of(first.column), .y = ground.y_of(first.row)};
  bool cliffs_about = true;
  std::vector<Cell> open{first};
  seen[ground.index(first.column, first.row)] = 1;
  while (!open.empty()) {
    const Cell cell = open.back();
    open.pop_back();
    ++patch.points;
    for_each_neighbour(ground, cell, [&](const Cell& next, double distance) {
      const double other = ground.at(next.column, next.row);
      char& is_seen = seen[ground.index(next.column, next.row)];
      if (other != height) {
        cliffs_about = cliffs_about && is_cliff(height, other, distance);
        patch.lowest = std::min(patch.lowest, other);
        patch.highest = std::max(patch.highest, other);
      } else if (is_seen == 0) {
        is_seen = 1;
        open.push_back(next);
      }
    });
  }
  return cliffs_about ? std::optional(patch) : std::nullopt;
}

// Patches by value. A patch surrounded by cliffs begins at a point next to a cliff.
std::map<double, Apart> patches_of(const Raster& ground) {
  std::map<double, Apart> found;
  std::vector<char> seen(ground.values.size(), 0);
  for_each_point(ground, [&](int column, int row, double height) {
    bool at_cliff = false;
    if (seen[ground.index(column, row)] == 0 && !std::isnan(height)) {
      for_each_neighbour(ground, {column, row}, [&](const Cell& next, double distance) {
        at_cliff = at_cliff || is_cliff(height, ground.at(next.column, next.row), distance);
      });
    }
    if (const auto patch = at_cliff ? patch_at(ground, {column, row}, seen) : std::nullopt) {
      Apart& all = found.try_emplace(height, Apart{.x = patch->x, .y = patch->y}).first->second;
      all.points += patch->points;
      all.lowest = std::min(all.lowest, patch->lowest);
      all.highest = std::max(all.highest, patch->highest);
    }
  });
  return found;
}

}  // namespace

std::vector<std::string> probes_in_holes(const config::Site& site) {
  const Raster& ground = *site.ground;
  std::vector<std::string> warnings;
  for (const auto& [name, corners] : site.probes) {
    const bool is_known = std::ranges::any_of(corners, [&](const auto& corner) {
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
  for_each_point(ground, [&](int column, int row, double height) {
    const double x = ground.x_of(column), y = ground.y_of(row);
    if (!domain.contains(x, y)) {
      return;
    }
    ++points;
    const double distance = std::isnan(height) ? distance_to_releases(site, x, y) : HUGE_VAL;
    if (std::isnan(height) && (unknown++ == 0 || distance < nearest)) {
      nearest = distance;
      nearest_x = x;
      nearest_y = y;
    }
  });
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

std::string pits_warning(const std::string& file, const Raster& ground) {
  double value = 0.0;
  Apart most;
  for (const auto& [height, apart] : patches_of(ground)) {
    if (apart.points > most.points && (apart.points > 1 || height == 0.0)) {
      value = height;
      most = apart;
    }
  }
  if (most.points == 0) {
    return "";
  }
  const std::string path = name_of_file(file);
  return fmt::format(
      "{} point{} of {} {} exactly {:.9g} m among heights of {:.0f} to {:.0f} m, such as ({:.0f}, {:.0f}): a hole "
      "without data? Then declare it in the file, gdal_edit.py -a_nodata {:.9g} {}, or fill it",
      most.points, most.points == 1 ? "" : "s", path, most.points == 1 ? "is" : "are", value, most.lowest, most.highest,
      most.x, most.y, value, file);
}

std::string thickness_warning(const std::string& file, const Raster& ground) {
  bool is_edge_zero = true, has_height = false;
  for_each_point(ground, [&](int column, int row, double value) {
    const bool is_edge = row == 0 || row + 1 == ground.rows || column == 0 || column + 1 == ground.columns;
    is_edge_zero = is_edge_zero && (!is_edge || value == 0.0);
    has_height = has_height || (value != 0.0 && !std::isnan(value));
  });
  return !is_edge_zero || !has_height
             ? ""
             : fmt::format(
                   "{}: all elevations at its edge are 0, but not inside: is it a raster of the thickness, swapped "
                   "with the DEM? If it is, correct the path",
                   name_of_file(file));
}

}  // namespace thawslide::gis
