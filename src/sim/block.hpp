// The rigid-block model: the same case without deformation. The body, cut into vertical slices, keeps its shape and
// slides along the terrain; under it one column of particle rows carries the band's heat and pore pressure, through the
// stages of the MPM's own step. The rows stand where the MPM's particles stand on flat ground, so that on a plane
// aligned with the grid the two agree. What it leaves out: deformation, differences of the band along the base, and,
// unless block.bends is on, the pressure of bends along the way. Of a 3D case on a DEM it slides the section along a
// path (path_section.hpp).
#pragma once

#include "base/table.hpp"
#include "config/site.hpp"
#include "sim/history.hpp"

namespace thawslide::sim {

// Throws UserError for a case with more than one body.
void require_one_body(const config::Case& parameters);

// Runs the case as a rigid block until time.end, with the case's fixed step, or the adaptive one's limit. One row each
// time.history_interval (0: each step), first the state at t = 0. Columns: time_s, velocity_m_s, displacement_m,
// front_position_m, normal_pressure_Pa and pore_pressure_Pa at the base, sliding_strength_Pa, driving_traction_Pa,
// band_temperature_C, band_saturation, band_pore_pressure_Pa, band_friction_coefficient, friction_work_J_m2,
// friction_heat_J_m2 and heat_gain_J_m2, the last three per base area; valley_factor: the area of the base over that of
// the section's profile (valley_factor.hpp). Velocity, displacement and driving traction count in the direction in
// which the block leaves, the front is an x. site: holds the profile of a section. valley_factor: over x. Throws
// UserError for a case without terrain, with more than one body, or with a step above a limit.
std::vector<HistoryRow> run_block(const config::Case& parameters, const config::Site& site = {},
                                  Table valley_factor = Table(1.0));

}  // namespace thawslide::sim
