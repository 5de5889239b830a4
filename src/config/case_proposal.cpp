#include "config/case_proposal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "base/rounding.hpp"
#include "config/resolution.hpp"
#include "config/rule.hpp"
#include "config/site.hpp"
#include "config/values.hpp"

namespace thawslide::config {

namespace {

constexpr double degree = 3.14159265358979323846 / 180.0;
constexpr double slow = 20.0;  // m/s: a slide that crosses its domain at this speed reaches the far side
constexpr double shortest_run = 60.0, longest_run = 400.0;  // [s]
constexpr double rest_speed = 0.05;                         // m/s: default of `run` for a case without the key
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

// Distance from the bounding box of the release to the nearest DEM edge or no-data point [m]. The search ends at `most`
// [m], which is returned if nothing is nearer.
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

// Domain along x or y that contains `held` within the DEM. It begins and ends at multiples of four cells. If that would
// cut the release at the edge of the DEM, it ends at multiples of a cell, or otherwise at the edge of the DEM.
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

double quick_cell(const Proposal& proposal) {
  return cell_of(Resolution::quick, proposal.thickness, proposal.median_thickness, proposal.particles_per_axis);
}

BodyOnCells release_on_cells(const Proposal& proposal) {
  return {.name = "slide",
          .thickness = proposal.median_thickness,
          .cell = proposal.cell,
          .particles_per_axis = proposal.particles_per_axis,
          .has_maps = true};
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

void propose_cell(Proposal& proposal, int dimension, double cell, Resolution resolution) {
  proposal.cell = cell > 0.0
                      ? cell
                      : cell_of(resolution, proposal.thickness, proposal.median_thickness, proposal.particles_per_axis);
  proposal.particles = proposal.volume / std::pow(proposal.cell / proposal.particles_per_axis, dimension);
}

void propose_times(Proposal& proposal, double farthest) {
  proposal.end = std::clamp(10.0 * std::ceil(farthest / slow / 10.0), shortest_run, longest_run);
  proposal.output_interval = round_down(proposal.end / snapshots);
}

namespace {

double degrees_of(double rise) { return std::atan(rise) / degree; }

std::string taper_text(const EdgeTaper& taper) {
  if (!(taper.width > 0.0) && !taper.is_cramped()) {
    return "taper = 0.0  # m; the points of the DEM are so far apart that the edges of the cut are ramps already\n";
  }
  return fmt::format(
      "# The edges of the cut are ramps of this width, half of it beyond the outline, and the volume is preserved. "
      "Vertical\n"
      "# edges would trap the slide. At their steepest, the ramps rise {:.1f} degrees against the DEM, which falls "
      "{:.1f}\n"
      "# degrees here{}.\ntaper = {}  # m\n",
      degrees_of(taper.steepest), degrees_of(taper.slope),
      taper.is_cramped() ? fmt::format("; {} m is needed, but the release is too narrow", number_text(taper.wanted))
                         : "",
      number_text(taper.width));
}

}  // namespace

std::string case_text(const ProposalInput& input, const Proposal& proposal) {
  const bool is_cut = input.placement == Placement::cut;
  std::string text = fmt::format(
      R"(# Made by `thawslide new`. Every number may be changed; `thawslide describe` lists all keys.

[case]
title = {title}
dimension = 3  # x is east, y is north, z is up

{time}
# The domain: a box around the release and all terrain below a line that descends at {angle} degrees from its top. Empty
# cells cost nothing.
[grid]
cell = {cell}  # m; {across}
{maps}min = {min}
max = {max}
leaving = "remove"  # what leaves the domain or the DEM is removed, and its mass reported; "stop": it ends the run

[terrain]
type = "dem"
file = {dem}
smooth = {filter}  # m: filter of the DEM, at least one cell of `quick`, so that finer cells have the same ground

[body.slide]
material = "rock_ice"
shape = "release"
{release}thickness = {given}  # m
thickness_along = "vertical"  # "normal": across the slope
placement = "{placement}"  # {placement_text}
{taper}{confirmed}{state}
{physics}{substrates}
# Maps are updated in every time step.
[maps]
arrival_thickness = 0.1  # m: thickness from which the avalanche counts as arrived
)",
      fmt::arg("title", quoted(input.title)), fmt::arg("time", time_text(proposal)),
      fmt::arg("angle", input.reach_angle), fmt::arg("cell", number_text(proposal.cell)),
      fmt::arg("across", cell_comment(proposal)), fmt::arg("maps", maps_comment(release_on_cells(proposal))),
      fmt::arg("confirmed", input.largest_volume > 0.0
                                ? fmt::format("largest_volume = {}  # m3\n", number_text(input.largest_volume))
                                : std::string()),
      fmt::arg("state", body_state_text(proposal)), fmt::arg("physics", physics_text(input.base)),
      fmt::arg("substrates", substrate_tables(input.outlines)),
      fmt::arg("taper", is_cut ? taper_text(input.taper) : std::string()), fmt::arg("min", corner_text(proposal.min)),
      fmt::arg("max", corner_text(proposal.max)), fmt::arg("dem", quoted(input.dem_file)),
      fmt::arg("filter", number_text(input.filter)),
      fmt::arg("release",
               input.release_file.empty() ? std::string() : fmt::format("release = {}\n", quoted(input.release_file))),
      fmt::arg("given", Value<MapValue>::write(input.thickness, {}, {})),
      fmt::arg("placement", is_cut ? "cut" : "on_top"),
      fmt::arg("placement_text", is_cut ? "out of the DEM, which is the surface before the slide; \"on_top\": onto it"
                                        : "the DEM is the sliding surface; \"cut\": out of the DEM"));
  return text;
}

std::string corner_text(const Point& corner) { return Value<Point>::write(corner, {}, WriteContext{3, {}}); }

std::string time_text(const Proposal& proposal) {
  return fmt::format(R"([time]
end = {}  # s, at the latest; make it longer if the slide still moves
stop_at_rest = {}  # m/s; the run ends once the slide has been slower for time.rest_time; 0: it runs to the end
stepping = "adaptive"
output_interval = {}  # s between snapshots of all particles
history_interval = {}
)",
                     number_text(proposal.end), number_text(rest_speed), number_text(proposal.output_interval),
                     number_text(proposal.output_interval / 5.0));
}

std::string cell_comment(const Proposal& proposal) {
  return fmt::format("two particles a cell and axis make {:.1f} across a thickness of {} m",
                     proposal.thickness * proposal.particles_per_axis / proposal.cell,
                     rounded_text(proposal.thickness, 3));
}

std::string body_state_text(const Proposal& proposal) {
  return fmt::format(R"(particles_per_axis = {}
temperature = -5.0  # C, of rock and ice at the start
porosity = 0.375  # volume fraction of ice: all pores are full of it
)",
                     proposal.particles_per_axis);
}

std::string physics_text(const std::optional<ProposedBase>& base) {
  std::string strength, band = "# The thinner the band, the sooner it melts.\n";
  if (base && base->missing_cohesion > 0.0) {
    strength = fmt::format(
        "# With this friction the release could not have stood: its safety factor is {:.2g} at the start. {} Pa of\n"
        "# cohesion (basal.cohesion, basal.slip_distance), lost since, would have held it.\n",
        base->safety_factor, rounded_text(base->missing_cohesion, 2));
  }
  if (base) {
    band = fmt::format(
        "# {} of {} to {} m that a rigid block without pore pressure does not heat above {:g} C: {:.0f} C\n"
        "# here (docs/theory/block-model.md). A thinner band melts sooner.\n",
        base->temperature > ProposedBase::limit ? "There is no band" : "The thinnest band",
        ProposedBase::candidates.back(), ProposedBase::candidates.front(), ProposedBase::limit, base->temperature);
  }
  return fmt::format(R"([mechanics]
transfer = "apic"  # particle velocities without noise: the slide comes to rest, and swells less than with "flip"

# Broken rock and ice.
[material.rock_ice]
law = "mohr_coulomb"
youngs_modulus = 1.0e8
poisson_ratio = 0.2
friction_angle = 35.0
cohesion = 1.0e3
gaps_close_first = true  # separated material carries no load until its gap closes
hydraulic_conductivity = 1.0e-6  # m/s; the smaller, the longer meltwater stays under pressure

# The base. Sliding heats a shear band, its ice melts, friction falls, and the meltwater carries part of the weight.
[basal]
friction = "lubricated"  # "constant": plain Coulomb friction
{strength}friction_angle = 25.0  # degrees, before anything has melted: the most influential parameter
heat_fraction = 0.9  # fraction of the friction work that heats the band

[band]
model = "columns"
{band}thickness = {thickness:.1f}  # m
)",
                     fmt::arg("strength", strength), fmt::arg("band", band),
                     fmt::arg("thickness", base ? base->thickness : ProposedBase().thickness));
}

}  // namespace thawslide::config
