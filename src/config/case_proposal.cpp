#include "config/case_proposal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "config/rule.hpp"

namespace thawslide::config {

namespace {

constexpr double degree = 3.14159265358979323846 / 180.0;
constexpr double particles_across = 6.0;
constexpr double slow = 20.0;  // m/s: a slide that crosses its domain at this speed gets to its end
constexpr double shortest_run = 60.0, longest_run = 400.0;  // [s]
constexpr double block_cells = 4.0;  // the domain is a multiple of, so that the cell may be doubled twice
constexpr double snapshots = 40.0;   // about as many

// The release in numbers.
struct ReleaseExtent {
  double volume = 0.0, thickness = 0.0;  // [m3], [m]: half of the volume is where the release is thinner
  double west = HUGE_VAL, east = -HUGE_VAL, south = HUGE_VAL, north = -HUGE_VAL;
  double top = -HUGE_VAL, top_x = 0.0, top_y = 0.0;  // highest point of its surface
};

double nearest_height(const Raster& dem, double x, double y) {
  const auto clamp = [](double place, int count) {
    return static_cast<int>(std::clamp(std::lround(place), 0L, static_cast<long>(count) - 1));
  };
  return dem.at(clamp((x - dem.x) / dem.cell_x, dem.columns), clamp((y - dem.y) / dem.cell_y, dem.rows));
}

ReleaseExtent extent_of(const Raster& dem, const Raster& thickness) {
  ReleaseExtent extent;
  std::vector<double> thicknesses;
  const double area = thickness.cell_x * thickness.cell_y;
  for (int row = 0; row < thickness.rows; ++row) {
    for (int column = 0; column < thickness.columns; ++column) {
      const double t = thickness.at(column, row);
      if (!(t > 0.0)) {
        continue;
      }
      const double x = thickness.x_of(column), y = thickness.y_of(row);
      extent.volume += t * area;
      thicknesses.push_back(t);
      extent.west = std::min(extent.west, x);
      extent.east = std::max(extent.east, x);
      extent.south = std::min(extent.south, y);
      extent.north = std::max(extent.north, y);
      const double top = nearest_height(dem, x, y) + t;
      if (top > extent.top) {
        extent.top = top;
        extent.top_x = x;
        extent.top_y = y;
      }
    }
  }
  std::sort(thicknesses.begin(), thicknesses.end());
  double below = 0.0;
  for (const double t : thicknesses) {
    extent.thickness = t;
    below += t * area;
    if (below >= 0.5 * extent.volume) {
      break;
    }
  }
  return extent;
}

// Without the round-off of a product, which nobody wants to read in a file.
double tidy(double number) { return std::stod(fmt::format("{:.12g}", number)); }

}  // namespace

double round_down(double x) {
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  double best = tidy(power);
  for (const double digit : {1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0}) {
    best = digit * power <= x * (1.0 + 1e-12) ? tidy(digit * power) : best;
  }
  return best;
}

Proposal propose(const Raster& dem, const Raster& thickness, double reach_angle) {
  const ReleaseExtent release = extent_of(dem, thickness);
  Proposal proposal;
  proposal.volume = release.volume;
  proposal.thickness = release.thickness;
  propose_cell(proposal, 3);

  double west = release.west, east = release.east, south = release.south, north = release.north;
  double lowest = release.top, farthest = 0.0;
  const double fall = std::tan(reach_angle * degree);
  for (int row = 0; row < dem.rows; ++row) {
    for (int column = 0; column < dem.columns; ++column) {
      const double height = dem.at(column, row);
      const double x = dem.x_of(column), y = dem.y_of(row);
      const double distance = std::hypot(x - release.top_x, y - release.top_y);
      if (std::isnan(height) || height > release.top - fall * distance) {
        continue;
      }
      west = std::min(west, x);
      east = std::max(east, x);
      south = std::min(south, y);
      north = std::max(north, y);
      lowest = std::min(lowest, height);
      farthest = std::max(farthest, distance);
    }
  }
  const double margin = margin_cells * proposal.cell;
  // In whole blocks of cells, or where these would cut the release at the edge of the DEM in single cells.
  for (const double block : {block_cells * proposal.cell, proposal.cell}) {
    const auto down = [&](double place) { return tidy(std::floor(place / block + 1e-9) * block); };
    const auto up = [&](double place) { return tidy(std::ceil(place / block - 1e-9) * block); };
    proposal.min = {std::max(up(dem.x), down(west - margin)), std::max(up(dem.y), down(south - margin)),
                    down(lowest - margin)};
    proposal.max = {std::min(down(dem.x_end()), up(east + margin)), std::min(down(dem.y_end()), up(north + margin)),
                    up(release.top + margin)};
    if (proposal.min[0] <= release.west && proposal.max[0] >= release.east && proposal.min[1] <= release.south &&
        proposal.max[1] >= release.north) {
      break;
    }
  }
  propose_times(proposal, farthest);
  return proposal;
}

void propose_cell(Proposal& proposal, int dimension) {
  proposal.cell = round_down(proposal.thickness * proposal.particles_per_axis / particles_across);
  proposal.particles = proposal.volume / std::pow(proposal.cell / proposal.particles_per_axis, dimension);
}

void propose_times(Proposal& proposal, double farthest) {
  proposal.end = std::clamp(10.0 * std::ceil(farthest / slow / 10.0), shortest_run, longest_run);
  proposal.output_interval = round_down(proposal.end / snapshots);
}

namespace {

std::string thickness_text(const MapValue& thickness) {
  if (thickness.from == MapValue::From::number) {
    return number_text(thickness.number);
  }
  const char* const kind = thickness.from == MapValue::From::attribute ? "attribute" : "raster";
  return fmt::format("{{ {} = \"{}\" }}", kind, thickness.source);
}

std::string point_text(const Point& point) {
  return fmt::format("[{}, {}, {}]", number_text(point[0]), number_text(point[1]), number_text(point[2]));
}

}  // namespace

std::string case_text(const ProposalInput& input, const Proposal& proposal) {
  const bool is_cut = input.placement == Placement::cut;
  std::string text = fmt::format(
      R"(# Made by `thawslide new`. Every number may be changed; `thawslide describe` tells what keys there are.

[case]
title = "{title}"
dimension = 3  # x is east, y is north, z is up

{time}
# The domain: a box about the release and all ground above a line that falls {angle} degrees from its top. Its size costs
# nothing, as only cells near the slide take memory and time.
[grid]
cell = {cell}  # m; {across}
min = {min}
max = {max}
leaving = "stop"  # what reaches the edge of the domain or of the DEM ends the run; "remove" counts and removes it

[terrain]
type = "dem"
file = "{dem}"

[body.slide]
material = "rock_ice"
shape = "release"
{release}thickness = {given}  # m
thickness_along = "vertical"  # "normal": across the slope
placement = "{placement}"  # {placement_text}
{confirmed}{state}
{physics}
# Maps are gathered every step.
[maps]
arrival_thickness = 0.1  # m: where it is less, the slide has not arrived
)",
      fmt::arg("title", input.title), fmt::arg("time", time_text(proposal)), fmt::arg("angle", input.reach_angle),
      fmt::arg("cell", number_text(proposal.cell)), fmt::arg("across", cell_comment(proposal)),
      fmt::arg("confirmed", input.largest_volume > 0.0
                                ? fmt::format("largest_volume = {}  # m3\n", number_text(input.largest_volume))
                                : std::string()),
      fmt::arg("state", body_state_text(proposal)), fmt::arg("physics", physics_text()),
      fmt::arg("min", point_text(proposal.min)), fmt::arg("max", point_text(proposal.max)),
      fmt::arg("dem", input.dem_file),
      fmt::arg("release",
               input.release_file.empty() ? std::string() : fmt::format("release = \"{}\"\n", input.release_file)),
      fmt::arg("given", thickness_text(input.thickness)), fmt::arg("placement", is_cut ? "cut" : "on_top"),
      fmt::arg("placement_text", is_cut ? "out of the DEM, which is the surface before the slide; \"on_top\": onto it"
                                        : "the DEM is what it slides on; \"cut\": out of the DEM"));
  return text;
}

std::string time_text(const Proposal& proposal) {
  return fmt::format(R"([time]
end = {}  # s; make it longer if the slide still moves
stepping = "adaptive"
output_interval = {}  # s between snapshots of all particles
history_interval = {}
)",
                     number_text(proposal.end), number_text(proposal.output_interval),
                     number_text(proposal.output_interval / 5.0));
}

std::string cell_comment(const Proposal& proposal) {
  return fmt::format("two particles a cell and axis make {:.1f} across a thickness of {:.3g} m",
                     proposal.thickness * proposal.particles_per_axis / proposal.cell, proposal.thickness);
}

std::string body_state_text(const Proposal& proposal) {
  return fmt::format(R"(particles_per_axis = {}
temperature = -5.0  # C, of rock and ice at the start
porosity = 0.375  # share of ice in the volume: all pores are full of it
)",
                     proposal.particles_per_axis);
}

std::string physics_text() {
  return R"(# Broken rock and ice.
[material.rock_ice]
law = "mohr_coulomb"
youngs_modulus = 1.0e8
poisson_ratio = 0.2
friction_angle = 35.0
cohesion = 1.0e3
gaps_close_first = true  # what is torn apart bears nothing until it touches again
viscosity_time = 0.02
hydraulic_conductivity = 1.0e-6  # m/s; the smaller, the longer meltwater stays under pressure

# The base. Sliding heats a shear band, its ice melts, friction falls, and the meltwater carries part of the weight.
[basal]
friction = "lubricated"  # "constant": plain Coulomb friction
friction_angle = 25.0  # degrees, before anything has melted: what the result hangs on most
heat_fraction = 0.35  # share of the friction work that heats the band

[band]
thickness = 0.2  # m; the thinner, the sooner it melts
)";
}

}  // namespace thawslide::config
