#include "config/section_proposal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/rule.hpp"
#include "config/values.hpp"

namespace thawslide::config {

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
  propose_cell(proposal, 2);
  propose_times(proposal, profile.distance.back() - body.begin);
  const double cell = proposal.cell;
  const double lowest = *std::min_element(profile.terrain.begin(), profile.terrain.end());
  const double highest = *std::max_element(profile.surface.begin(), profile.surface.end());
  const double cells = std::floor(profile.distance.back() / cell * (1.0 + 1e-12));
  proposal.min = {0.0, (std::floor(lowest / cell) - margin_cells) * cell, 0.0};
  proposal.max = {cells * cell, (std::ceil(highest / cell) + margin_cells) * cell, 0.0};
  return proposal;
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
min = [{min_x}, {min_y}]
max = [{max_x}, {max_y}]
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
      fmt::arg("min_x", number_text(proposal.min[0])), fmt::arg("min_y", number_text(proposal.min[1])),
      fmt::arg("max_x", number_text(proposal.max[0])), fmt::arg("max_y", number_text(proposal.max[1])),
      fmt::arg("profile", quoted(profile_file)), fmt::arg("state", body_state_text(proposal)),
      fmt::arg("physics", physics_text(base)));
}

}  // namespace thawslide::config
