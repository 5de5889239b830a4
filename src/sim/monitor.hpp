// State of the run monitor (guards, rest), which is stored in checkpoints.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>

#include "mpm/monitor_sums.hpp"

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

// Number of particles removed from a run, by cause.
struct Removed {
  std::int64_t left = 0, not_finite = 0, volume = 0;

  [[nodiscard]] std::int64_t by_guards() const { return not_finite + volume; }
};

// Text such as "12 particles: 3 not finite, 9 by their volume" for particles removed by guards.
[[nodiscard]] inline std::string text_of(const Removed& removed) {
  return fmt::format("{} particle{}: {} not finite, {} by their volume", removed.by_guards(),
                     removed.by_guards() == 1 ? "" : "s", removed.not_finite, removed.volume);
}

}  // namespace thawslide::sim
