// Monitor of a run: unexplained energy growth, volume limits, and rest. Its state is stored in checkpoints.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "mpm/monitor_sums.hpp"
#include "sim/solver/budget.hpp"
#include "sim/solver/clock.hpp"
#include "sim/solver/slide.hpp"
#include "sim/solver/solver.hpp"

namespace thawslide::sim {

// Steps between two checks. An instability takes longer to grow from one per cent of the energy to all of it.
inline constexpr std::int64_t watch_interval = 10;

// Fraction of the mass that may move while the slide is at rest. The front excludes the same fraction, so a few rolling
// particles do not prevent rest.
inline constexpr double moving_fraction_at_rest = 0.005;

// Default speed of a slide at rest [m/s] if time.stop_at_rest is not specified. At this speed the slide moves by less
// than a cell in time.rest_time.
inline constexpr double usual_rest_speed = 0.05;

// Reasons reported for a run that ended at rest.
inline constexpr const char* at_rest = "the slide is at rest";
inline constexpr const char* not_moved = "the slide has not moved";

struct RunMonitor {
  double energy_at_start = 0.0;  // elastic energy at t = 0 [J]
  double largest_energy = 0.0;   // maximum of the total energy held, moved or dissipated [J]
  double lowest_made = 0.0;      // recent minimum of the unexplained energy [J]
  double first_step = 0.0;       // adaptive step at t = 0, or when stepping became adaptive [s]; 0 with fixed steps
  double rest_since = -1.0;      // [s]; negative while moving
  double has_moved =
      0.0;  // 1: more than moving_fraction_at_rest has been faster than time.stop_at_rest; -1: not checked
  // Unexplained energy since t = 0 at the last check, as a fraction of the total. Not in checkpoints.
  double made_fraction = 0.0;

  // Calls visit(number) for each number in a checkpoint, in order.
  template <class Visit>
  void for_each(const Visit& visit) {
    for (double* number : {&energy_at_start, &largest_energy, &lowest_made, &first_step, &rest_since, &has_moved}) {
      visit(*number);
    }
  }
};

// Sums over the particles that the monitor needs. dt: last step [s].
template <int Dim>
[[nodiscard]] mpm::MonitorKernel<Dim> monitor_kernel(const Setup<Dim>& setup, double dt);

// Monitor at t = 0, except for its first step. seen: sums over the particles.
template <int Dim>
[[nodiscard]] RunMonitor monitor_at_start(const Setup<Dim>& setup, const Slide<Dim>& slide, const Budget<Dim>& budget,
                                          const mpm::MonitorSums& seen);

// Energy that has grown without a physical cause, in Joule and as a fraction of all energy so far.
struct EnergyGrowth {
  double energy, fraction;
};
// Compares the energy of the particles with the budget. Empty unless the run is unstable.
template <int Dim>
[[nodiscard]] std::optional<EnergyGrowth> check_energy(const Setup<Dim>& setup, const Budget<Dim>& budget,
                                                       const mpm::MonitorSums& seen, RunMonitor& monitor);

// Updates whether the slide is at rest. The particles are read only if the criterion has changed (resume --set).
template <int Dim>
void update_rest(const Setup<Dim>& setup, double time, const mpm::MonitorSums& seen, const Solver<Dim>& solver,
                 const Slide<Dim>& slide, RunMonitor& monitor);

// True if the slide is at rest: for time.rest_time, at most moving_fraction_at_rest of the mass has been faster than
// time.stop_at_rest or, by default, usual_rest_speed.
template <int Dim>
[[nodiscard]] bool is_at_rest(const Setup<Dim>& setup, const Clock& clock, const RunMonitor& monitor);

// This criterion as text.
template <int Dim>
[[nodiscard]] std::string rest_rule(const Setup<Dim>& setup);

// Time since when the slide is at rest, as text.
[[nodiscard]] std::string rest_text(const config::Time& times, bool has_moved, const RunMonitor& monitor);

// Warning of slow unexplained energy growth by more than guards.energy_growth; empty if there is none.
[[nodiscard]] std::string energy_warning(const config::Guards& guards, double time, const RunMonitor& monitor);

}  // namespace thawslide::sim
