// The state that a run has come to: whether the slide is at rest, how far dilation has changed its volume, and how much
// of its mass has left; and the warnings that follow, for the terminal, run.json and the report alike.
//   dilation = (sum of V - sum of V0) / sum of V0
// V: volume of a particle; V0: at t = 0 or, of material that the slide has entrained, when it joined. So entrainment
// and removal do not count.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sim/simulation.hpp"

namespace thawslide::sim {

// The change of volume by dilation from which on it is reported as a warning, as a share. Release volumes from
// differences of DEMs are known to about as much, so a smaller change is within the uncertainty of the input;
// a larger one makes thicknesses, areas and volumes of the result wrong by more than that.
inline constexpr double noticed_dilation = 0.05;

struct EndState {
  double time = 0.0;           // [s]
  bool is_known = false;       // of the motion: no, if nothing of the slide is left, a device failed, or nothing moves
  bool at_rest = false;        // Simulation::is_at_rest
  double rest_since = 0.0;     // [s]; NaN while it is not at rest
  std::string rest_rule;       // what at rest means, in words
  double mean_velocity = 0.0;  // magnitude of the mean, as in the history [m/s]
  double dilation_volume = 0.0;  // [m3]; in 2D per metre of width, times case.width if that is given
  double dilation_share = 0.0;   // of the initial volume
  double left_mass = 0.0;        // of removed particles, by guards too, as in the history [kg], as dilation_volume
  double guarded_mass = 0.0;     // of that, by guards [kg]
  double whole_mass = 0.0;       // of all particles that there ever were [kg]
  std::int64_t left_particles = 0;
};

// slide_left: the whole slide has left.
template <int Dim>
[[nodiscard]] EndState end_state(const Simulation<Dim, double>& simulation, bool slide_left);

// By name and unit, for run.json.
[[nodiscard]] std::vector<std::pair<std::string, double>> named(const EndState& state);

// "at 60 s, at rest" or "at 60 s, not at rest": what the last state is called in names of maps.
[[nodiscard]] std::string when_text(const EndState& state);

// Whole sentences; empty: there is nothing to warn of. is_over: the run goes on no more by itself.
[[nodiscard]] std::vector<std::string> warnings_of(const EndState& state, bool is_over);

}  // namespace thawslide::sim
