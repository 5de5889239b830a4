#include "config/case_proposal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>
#include <vector>

#include "base/rounding.hpp"
#include "config/rule.hpp"
#include "config/site.hpp"
#include "config/values.hpp"

namespace thawslide::config {

namespace {

constexpr double degree = 3.14159265358979323846 / 180.0;
constexpr double slow = 20.0;  // m/s: a slide that crosses its domain at this speed reaches the far side
constexpr double shortest_run = 60.0, longest_run = 400.0;  // [s]
constexpr double block_cells = 4.0;  // the domain is a multiple of this, so the cell can be doubled twice
constexpr double snapshots = 40.0;   // approximate number

// Dimensions of the release. Edge and top include the surrounding DEM points, because both lie between points.
struct ReleaseExtent {
  double volume = 0.0, thickness = 0.0;  // [m3], [m]: half of the volume lies where the release is thinner
  double median_thickness = 0.0;         // [m]: half of the area lies where the release is thinner
  double west = HUGE_VAL, east = -HUGE_VAL, south = HUGE_VAL, north = -HUGE_VAL;
  double bottom = HUGE_VAL;  // also for an excavated release
  double top = -HUGE_VAL, top_x = 0.0, top_y = 0.0;
};

struct Heights {
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
};

// Range of the 3 x 3 points around a position.
Heights heights_about(const Raster& dem, double x, double y) {
  const long column = std::lround((x - dem.x) / dem.cell_x), row = std::lround((y - dem.y) / dem.cell_y);
  Heights heights;
  for (long j = std::max(row - 1, 0L); j <= std::min(row + 1, static_cast<long>(dem.rows) - 1); ++j) {
    for (long i = std::max(column - 1, 0L); i <= std::min(column + 1, static_cast<long>(dem.columns) - 1); ++i) {
      const double height = dem.at(static_cast<int>(i), static_cast<int>(j));
      if (!std::isnan(height)) {
        heights.lowest = std::min(heights.lowest, height);
        heights.highest = std::max(heights.highest, height);
      }
    }
  }
  return heights;
}

// Thickness below which half of the volume lies.
double thickness_of_half_the_volume(std::vector<double> thicknesses) {
  std::sort(thicknesses.begin(), thicknesses.end());
  const double half = 0.5 * std::accumulate(thicknesses.begin(), thicknesses.end(), 0.0);
  double below = 0.0;
  for (const double thickness : thicknesses) {
    below += thickness;
    if (below >= half) {
      return thickness;
    }
  }
  return 0.0;
}

// Thickness below which half of the area lies.
double median_of(std::vector<double> thicknesses) {
  if (thicknesses.empty()) {
    return 0.0;
  }
  const auto middle = thicknesses.begin() + static_cast<std::ptrdiff_t>((thicknesses.size() - 1) / 2);
  std::nth_element(thicknesses.begin(), middle, thicknesses.end());
  return *middle;
}

ReleaseExtent extent_of(const Raster& dem, const Raster& thickness) {
  ReleaseExtent extent;
  std::vector<double> thicknesses;
  for_points_of_release(thickness, [&](int column, int row) {
    const double t = thickness.at(column, row), x = thickness.x_of(column), y = thickness.y_of(row);
    extent.volume += t * thickness.cell_x * thickness.cell_y;
    thicknesses.push_back(t);
    extent.west = std::min(extent.west, std::max(x - thickness.cell_x, dem.x));
    extent.east = std::max(extent.east, std::min(x + thickness.cell_x, dem.x_end()));
    extent.south = std::min(extent.south, std::max(y - thickness.cell_y, dem.y));
    extent.north = std::max(extent.north, std::min(y + thickness.cell_y, dem.y_end()));
    const Heights ground = heights_about(dem, x, y);
    extent.bottom = std::min(extent.bottom, ground.lowest - t);
    if (ground.highest + t > extent.top) {
      extent.top = ground.highest + t;
      extent.top_x = x;
      extent.top_y = y;
    }
  });
  extent.thickness = thickness_of_half_the_volume(thicknesses);
  extent.median_thickness = median_of(std::move(thicknesses));
  return extent;
}

// Distance from the bounding box of the release to the nearest DEM edge or no-data point [m], at most `most`.
double distance_to_edge(const Raster& dem, const ReleaseExtent& release, double most) {
  double nearest = std::min(
      {most, release.west - dem.x, dem.x_end() - release.east, release.south - dem.y, dem.y_end() - release.north});
  for (int row = 0; row < dem.rows; ++row) {
    const double y = std::max({release.south - dem.y_of(row), dem.y_of(row) - release.north, 0.0});
    for (int column = 0; column < dem.columns && y < nearest; ++column) {
      if (std::isnan(dem.at(column, row))) {
        const double x = std::max({release.west - dem.x_of(column), dem.x_of(column) - release.east, 0.0});
        nearest = std::min(nearest, std::hypot(x, y));
      }
    }
  }
  return nearest;
}

struct Stretch {
  double low = 0.0, high = 0.0;
};

// Domain along x or y within the DEM, between multiples of four cells. If that would cut the release at the edge of the
// DEM, it ends at multiples of a cell, or otherwise at the edge.
Stretch domain_along(const Stretch& given, const Stretch& release, const Stretch& dem, double cell) {
  Stretch domain;
  for (const double block : {block_cells * cell, cell}) {
    const auto down = [&](double coordinate) { return tidy(std::floor(coordinate / block + 1e-9) * block); };
    const auto up = [&](double coordinate) { return tidy(std::ceil(coordinate / block - 1e-9) * block); };
    domain = {std::max(up(dem.low), down(given.low)), std::min(down(dem.high), up(given.high))};
    if (domain.low <= release.low && domain.high >= release.high) {
      return domain;
    }
  }
  const auto whole_cells = [&](double length) { return std::floor(length / cell + 1e-9) * cell; };
  if (domain.low > release.low) {
    domain.low = dem.low;
    domain.high = domain.low + whole_cells(domain.high - domain.low);
  }
  if (domain.high < release.high) {
    const double low = std::max(dem.low, domain.low - cell);
    domain = {dem.high - whole_cells(dem.high - low), dem.high};
  }
  return domain;
}

// Sets the cell and the number of particles; needs volume and thicknesses. `cell`: as specified by the user, or 0.
void propose_cell(Proposal& proposal, int dimension, double cell, Resolution resolution) {
  proposal.cell = cell > 0.0 ? cell : cell_of(resolution, proposal);
  proposal.particles = proposal.volume / std::pow(proposal.cell / proposal.particles_per_axis, dimension);
}

// Sets the end and the interval between snapshots; farthest: maximum travel distance [m].
void propose_times(Proposal& proposal, double farthest) {
  proposal.end = std::clamp(10.0 * std::ceil(farthest / slow / 10.0), shortest_run, longest_run);
  proposal.output_interval = round_down(proposal.end / snapshots);
}

}  // namespace

double median_thickness(const Raster& thickness) {
  std::vector<double> known;
  std::copy_if(thickness.values.begin(), thickness.values.end(), std::back_inserter(known),
               [](double value) { return value > 0.0; });
  return median_of(std::move(known));
}

std::string edge_warning(const Proposal& proposal) {
  if (proposal.edge_distance >= proposal.length) {
    return "";
  }
  return fmt::format(
      "--dem: the release is close to the edge of the known terrain (found {} m; needed at least its own length, {} "
      "m). Particles that pass the edge are removed, and the results do not include them. Use a larger DEM",
      rounded_text(proposal.edge_distance, 2), rounded_text(proposal.length, 2));
}

double cell_of(Resolution resolution, const Proposal& proposal) {
  return cell_of(resolution, proposal.thickness, proposal.median_thickness, proposal.particles_per_axis);
}

Proposal propose(const Raster& dem, const Raster& thickness, double reach_angle, double cell, Resolution resolution) {
  const ReleaseExtent release = extent_of(dem, thickness);
  Proposal proposal;
  proposal.volume = release.volume;
  proposal.thickness = release.thickness;
  proposal.median_thickness = release.median_thickness;
  proposal.length = std::max(release.east - release.west, release.north - release.south);
  proposal.edge_distance = distance_to_edge(dem, release, proposal.length);
  propose_cell(proposal, 3, cell, resolution);

  Stretch x{release.west, release.east}, y{release.south, release.north};
  double lowest = release.bottom, farthest = 0.0;
  const double fall = std::tan(reach_angle * degree);
  for (int row = 0; row < dem.rows; ++row) {
    for (int column = 0; column < dem.columns; ++column) {
      const double height = dem.at(column, row);
      const double distance = std::hypot(dem.x_of(column) - release.top_x, dem.y_of(row) - release.top_y);
      if (std::isnan(height) || height > release.top - fall * distance) {
        continue;
      }
      x = {std::min(x.low, dem.x_of(column)), std::max(x.high, dem.x_of(column))};
      y = {std::min(y.low, dem.y_of(row)), std::max(y.high, dem.y_of(row))};
      lowest = std::min(lowest, height);
      farthest = std::max(farthest, distance);
    }
  }
  const double margin = margin_cells * proposal.cell, block = block_cells * proposal.cell;
  x = domain_along({x.low - margin, x.high + margin}, {release.west, release.east}, {dem.x, dem.x_end()},
                   proposal.cell);
  y = domain_along({y.low - margin, y.high + margin}, {release.south, release.north}, {dem.y, dem.y_end()},
                   proposal.cell);
  proposal.min = Point{x.low, y.low, tidy(std::floor((lowest - margin) / block) * block)};
  proposal.max = Point{x.high, y.high, tidy(std::ceil((release.top + margin) / block) * block)};
  propose_times(proposal, farthest);
  return proposal;
}

SurfaceBody body_on(const ProfileTable& profile) {
  SurfaceBody body;
  bool begun = false;
  double squares = 0.0;
  for (std::size_t k = 0; k + 1 < profile.distance.size(); ++k) {
    const double a = profile.surface[k] - profile.terrain[k], b = profile.surface[k + 1] - profile.terrain[k + 1];
    if (!(a > 0.0 || b > 0.0)) {
      continue;
    }
    const double length = profile.distance[k + 1] - profile.distance[k];
    body.begin = begun ? body.begin : profile.distance[k];
    body.end = profile.distance[k + 1];
    begun = true;
    body.area += 0.5 * (a + b) * length;
    squares += (a * a + a * b + b * b) / 3.0 * length;
  }
  body.thickness = begun ? squares / body.area : 0.0;
  return body;
}

Proposal propose_section(const ProfileTable& profile, const SurfaceBody& body) {
  Proposal proposal;
  proposal.volume = body.area;
  proposal.thickness = body.thickness;
  propose_cell(proposal, 2, 0.0, Resolution::quick);
  propose_times(proposal, profile.distance.back() - body.begin);
  const double cell = proposal.cell;
  const double lowest = *std::min_element(profile.terrain.begin(), profile.terrain.end());
  const double highest = *std::max_element(profile.surface.begin(), profile.surface.end());
  const double cells = std::floor(profile.distance.back() / cell * (1.0 + 1e-12));
  proposal.min = {0.0, (std::floor(lowest / cell) - margin_cells) * cell, 0.0};
  proposal.max = {cells * cell, (std::ceil(highest / cell) + margin_cells) * cell, 0.0};
  return proposal;
}

}  // namespace thawslide::config
