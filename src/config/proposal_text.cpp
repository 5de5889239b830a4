// Texts of new cases and of their sweep files.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/rounding.hpp"
#include "config/case_proposal.hpp"
#include "config/values.hpp"

namespace thawslide::config {

namespace {

constexpr double rest_speed = 0.05;  // m/s: default of `run` for a case without the key

double degrees_of(double rise) { return std::atan(rise) * 180.0 / pi; }

std::string taper_text(const EdgeTaper& taper) {
  if (!(taper.width > 0.0) && !taper.is_cramped()) {
    return "taper = 0.0  # m; the points of the DEM are so far apart that the edges of the cut are ramps already\n";
  }
  return fmt::format(
      "# The edges of the cut are ramps of this width, half of it beyond the outline, and the volume is preserved. "
      "Vertical\n# edges would trap the slide. At their steepest, the ramps rise {:.1f} degrees against the DEM, which "
      "falls "
      "{:.1f}\n# degrees here{}.\ntaper = {}  # m\n",
      degrees_of(taper.steepest), degrees_of(taper.slope),
      taper.is_cramped() ? fmt::format("; {} m is needed, but the release is too narrow", number_text(taper.wanted))
                         : "",
      number_text(taper.width));
}

// Corner of a domain.
std::string corner_text(const Point& corner, int dimension = 3) {
  return Value<Point>::write(corner, {}, WriteContext{dimension, {}});
}

// Table [time], without a trailing empty line.
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

// Number of particles across the thickness, for the comment at grid.cell.
std::string cell_comment(const Proposal& proposal) {
  return fmt::format("two particles a cell and axis make {:.1f} across a thickness of {} m",
                     proposal.thickness * proposal.particles_per_axis / proposal.cell,
                     rounded_text(proposal.thickness, 3));
}

// Last keys of the body: particles and initial state.
std::string body_state_text(const Proposal& proposal) {
  return fmt::format(R"(particles_per_axis = {}
temperature = -5.0  # C, of rock and ice at the start
porosity = 0.375  # volume fraction of ice: all pores are full of it
)",
                     proposal.particles_per_axis);
}

// Tables of transfer, material, base and band.
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

// Bed in the polygons of a substrate, as comments, since a case has one bed and most slides entrain none.
std::string bed_in_comments(const std::string& outline) {
  return fmt::format(
      R"(# An erodible bed in these polygons: remove the first # of each line below. All values are assumed.
# [bed]
# law = "momentum"
# outline = {}
# depth = 1.0  # m, at most grid.cell; {{ attribute = "depth" }}: of each polygon
# strength = 1.0e3  # Pa, without load
# friction_angle = 6.0  # degrees; the bed resists if its tangent exceeds the friction coefficient above
# depth_per_slip = 0.1  # m of bed per m of slip, at most
# material = "rock_ice"
# temperature = -5.0  # C
# porosity = 0.375  # volume fraction of ice and water
)",
      quoted(outline));
}

// Tables of the substrates.
std::string substrate_tables(const Outlines& outlines) {
  std::string text;
  for (const ProposedSubstrate& each : proposed_substrates) {
    if (const auto outline = outlines.find(each.name); outline != outlines.end()) {
      text += fmt::format(R"(
[substrate.{}]
outline = {}
friction = "coefficient"  # a fraction of the normal stress; it contains the pore pressure
friction_coefficient = {}  # assumed: {} to {}
)",
                          each.name, quoted(outline->second), each.coefficient, each.low, each.high);
      text += each.can_be_entrained ? bed_in_comments(outline->second) : "";
    }
  }
  return text;
}

// Ranges of a sweep file, in its table [sweep.range].
std::string substrate_ranges(const Outlines& outlines) {
  std::string text;
  for (const ProposedSubstrate& each : proposed_substrates) {
    if (outlines.count(each.name) > 0) {
      text +=
          fmt::format("# Fraction of the normal stress. Assumed.\n\"substrate.{}.friction_coefficient\" = [{}, {}]\n",
                      each.name, each.low, each.high);
    }
  }
  return text;
}

constexpr double truncation = 3.0;  // standard deviations, at which sweeps truncate lognormal distributions

// Median and standard deviation of the logarithm of a lognormal distribution between two values.
std::string lognormal_text(double low, double high) {
  return fmt::format("[{:.3g}, {:.3g}]", std::sqrt(low * high), 0.5 * std::log(high / low) / truncation);
}

// Young's modulus with which a slide is compressed by 2 % below its own weight, at most that of the case [Pa].
double modulus_of_members(double thickness) {
  constexpr double unit_weight = 2.0e4, compression = 0.02, of_case = 1e8;  // N/m3, -, Pa
  return std::min(of_case, rounded_up(unit_weight * thickness / compression, 1));
}

std::string cells_text(const std::optional<Proposal>& quick) {
  if (!quick) {
    return "";
  }
  return fmt::format("\"grid.cell\" = {}  # m, of `quick`\n\"grid.min\" = {}\n\"grid.max\" = {}\n",
                     number_text(quick->cell), corner_text(quick->min), corner_text(quick->max));
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
min = {min}
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
      fmt::arg("across", cell_comment(proposal)),
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

std::string section_text(const std::string& title, const std::string& profile_file, const Proposal& proposal,
                         const std::optional<ProposedBase>& base) {
  return fmt::format(
      R"(# Made by `thawslide section`. Every number may be changed; `thawslide describe` lists all keys.
#
# A section has no side walls and does not spread laterally: the slide moves only in the plane of the section, and is
# uniform across it. Valleys that narrow, widen or turn are not represented.

[case]
title = {title}
dimension = 2  # x is the distance along the line, y is up; masses, forces and energies are per metre of width

{time}
# The domain: the whole section. Its size costs nothing, as only cells near the slide take memory and time.
[grid]
cell = {cell}  # m; {across}
min = {min}
max = {max}
leaving = "remove"  # what leaves the domain is removed, and its mass reported; "stop": it ends the run

[terrain]
type = "profile"
file = {profile}

[body.slide]
material = "rock_ice"
shape = "surface"  # between terrain_elevation_m and surface_elevation_m of the profile
{state}
{physics})",
      fmt::arg("title", quoted(title)), fmt::arg("time", time_text(proposal)),
      fmt::arg("cell", number_text(proposal.cell)), fmt::arg("across", cell_comment(proposal)),
      fmt::arg("min", corner_text(proposal.min, 2)), fmt::arg("max", corner_text(proposal.max, 2)),
      fmt::arg("profile", quoted(profile_file)), fmt::arg("state", body_state_text(proposal)),
      fmt::arg("physics", physics_text(base)));
}

std::string sweep_text(double thickness, const ProposedBase& base, const std::optional<Proposal>& quick,
                       const Outlines& outlines) {
  constexpr double least_friction = 20.0, most_friction = 35.0;  // degrees
  constexpr double thinnest_band = 0.1, thickest_band = 1.0;     // m
  constexpr double low_ratio = 0.6, band_ratio = 0.05;
  const double high = std::clamp(std::floor(base.friction), 1.0, most_friction);
  const double low = std::min(least_friction, std::round(low_ratio * high * 10.0) / 10.0);
  const double thick = std::min(std::max(thickest_band, base.thickness), band_ratio * thickness);
  const double thin = std::min(thinnest_band, 0.5 * thick);
  return fmt::format(
      R"(# Made by `thawslide new` for `thawslide forecast`. Every number may be changed, and keys of the case added.
# "Assumed" ranges have no published source.

[sweep]
cases = ["case.toml"]
sample = "lhs:32"  # Latin hypercube of 32 members
seed = 1

# Members are less accurate than a run of case.toml, but many of them are needed.
[sweep.set]
# Pa: the slide is compressed by at most 2 % below its weight. A stiffer one needs more time steps.
"material.rock_ice.youngs_modulus" = {modulus:g}
"band.column_step" = 0.2  # s; on a slope of the Alps, travel distance and areas change by 1.3 % at most
"time.stop_at_rest" = 0.5  # m/s
"time.rest_time" = 2.0  # s
{cells}
[sweep.range]
# Degrees, before anything has melted. Assumed: {least:g} to {most:g} degrees, as for the broken body in
# docs/choosing-the-base.md. With more than {steepest:.1f} degrees and no cohesion, the rigid block would not leave. The
# lower end is at most {low_ratio:g} of the upper one.
"basal.friction_angle" = [{low:g}, {high:g}]
# Fraction of the friction work that heats the band: range of docs/choosing-the-base.md.
"basal.heat_fraction" = [0.8, 1.0]
# m. Range for forecasts of docs/choosing-the-base.md, 0.1 to 1 m, or up to the band of case.toml, but at most a
# twentieth of the slide, {thickness} m thick. Assumed: a thicker band is no longer a band.
"band.thickness" = [{thin:.3g}, {thick:.3g}]
# Degrees, of the broken material. Assumed: 35 degrees, as in docs/choosing-the-base.md, and 5 more or less.
"material.rock_ice.friction_angle" = [30.0, 40.0]
{substrates}
[sweep.lognormal]  # median, and standard deviation of the natural logarithm; truncated at 3 standard deviations
# m/s: between 1e-8 and 1e-5 m/s, the range of docs/choosing-the-base.md.
"material.rock_ice.hydraulic_conductivity" = {conductivity}

# What lies on the path decides as well. Polygons of a glacier, snow or the valley floor are options of `thawslide new`.
# If it can be entrained, add [bed] to the case.
)",
      fmt::arg("cells", cells_text(quick)), fmt::arg("substrates", substrate_ranges(outlines)),
      fmt::arg("least", least_friction), fmt::arg("most", most_friction), fmt::arg("steepest", base.friction),
      fmt::arg("low_ratio", low_ratio), fmt::arg("low", low), fmt::arg("high", high), fmt::arg("thin", thin),
      fmt::arg("thick", thick), fmt::arg("thickness", rounded_text(thickness, 3)),
      fmt::arg("modulus", modulus_of_members(thickness)), fmt::arg("conductivity", lognormal_text(1e-8, 1e-5)));
}

}  // namespace thawslide::config
