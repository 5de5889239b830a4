// Final state of a run: rest, change of volume by dilation, mass lost, and the resulting warnings for the terminal,
// run.json and the report.
//    dilation = (sum of V - sum of V0) / sum of V0
// V: volume of a particle; V0: at t = 0 or, for entrained material, when it joined. Entrainment and removal therefore
// do not count.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/state_numbers.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

// Relative change of volume by dilation above which a warning is given. Release volumes from differences of DEMs have a
// similar uncertainty. A larger change exceeds it and affects thicknesses, areas and volumes of the result.
inline constexpr double noticed_dilation = 0.05;

struct EndState {
  double time = 0.0;               // [s]
  bool is_known = false;           // of the motion; false if no slide is left, a device failed, or nothing moves
  bool at_rest = false;            // Simulation::is_at_rest
  bool has_moved = false;          // by more than time.moved_distance
  double rest_since = 0.0;         // [s]; NaN while moving
  std::string rest_rule;           // criterion of rest as text
  double mean_velocity = 0.0;      // magnitude of the mean velocity, as in the history [m/s]
  double dilation_volume = 0.0;    // [m3]; in 2D per metre of width, times case.width if specified
  double dilation_fraction = 0.0;  // fraction of the initial volume
  std::string dilation_remedy;     // sentence on what reduces it
  double left_mass = 0.0;     // of removed particles, guards included, as in the history [kg]; in 2D as dilation_volume
  double guarded_mass = 0.0;  // part of left_mass removed by guards [kg]
  double whole_mass = 0.0;    // of all particles, including removed ones [kg]
  std::int64_t left_particles = 0;
};

// slide_left: the whole slide has left.
template <int Dim>
[[nodiscard]] EndState end_state(const Simulation<Dim>& simulation, bool slide_left);

// Name with unit and value, for run.json.
[[nodiscard]] std::vector<std::pair<std::string, double>> named(const EndState& state);

// Label of the last state in map names: "at 60 s, at rest", "at 60 s, not at rest" or "at 60 s, has not moved".
[[nodiscard]] std::string when_text(const EndState& state);

// Complete sentences; empty if there is no warning. is_over: the run has ended.
[[nodiscard]] std::vector<std::string> warnings_of(const EndState& state, bool is_over);

// Table of the basal segments for snapshots: one row per segment at one time.

// Columns by name with unit; `position_m` holds x, y, z of each segment (z = 0 in 2D). The table is empty unless the
// band consists of columns. P, T and S are means over the band; `max_temperature_C` is the maximum of the column's
// cells above the ground.
template <int Dim>
NamedNumbers base_table(const Simulation<Dim>& simulation);

}  // namespace thawslide::sim
