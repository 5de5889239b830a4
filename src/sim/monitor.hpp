// What a run is watched for every few steps (guards, rest); a checkpoint keeps it.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>

#include "mpm/monitor_sums.hpp"

namespace thawslide::sim {

// Steps between two looks. An instability takes longer from one per cent of the energy to all of it.
inline constexpr std::int64_t watch_interval = 10;

// The share of the mass that may move while the slide is at rest: the front leaves the same share out, and so a stray
// particle keeps no deposit from being one.
inline constexpr double escaped_fraction = 0.005;

// The speed that a slide may move at and is at rest where time.stop_at_rest gives none [m/s]: it moves by less than a
// cell in time.rest_time then.
inline constexpr double usual_rest_speed = 0.05;

// How a run tells that it has ended at rest.
inline constexpr const char* at_rest = "the slide is at rest";

struct RunMonitor {
  double held_at_start = 0.0;   // elastic energy at t = 0 [J]
  double largest_energy = 0.0;  // largest so far of all that was held, moved or dissipated [J]
  double lowest_made = 0.0;     // lowest of late of the energy that nothing accounts for [J]
  double first_step = 0.0;      // the adaptive one at t = 0, or at which steps became adaptive [s]; 0: they are not
  double rest_since = -1.0;     // [s]; negative: it moves
  double has_moved = 0.0;       // 1: more than the stray share has been faster than time.stop_at_rest; -1: not looked
  // At the last look: energy that nothing accounts for since t = 0, as a share of all so far. In no checkpoint.
  double made_share = 0.0;

  // Calls visit(number) with each that a checkpoint keeps, in order.
  template <class Visit>
  void for_each(const Visit& visit) {
    for (double* number : {&held_at_start, &largest_energy, &lowest_made, &first_step, &rest_since, &has_moved}) {
      visit(*number);
    }
  }
};

// How many particles were taken out of a run, by cause.
struct Removed {
  std::int64_t left = 0, not_finite = 0, volume = 0;

  [[nodiscard]] std::int64_t by_guards() const { return not_finite + volume; }
};

// "12 particles: 3 not finite, 9 by their volume", of those that guards have removed.
[[nodiscard]] inline std::string text_of(const Removed& removed) {
  return fmt::format("{} particle{}: {} not finite, {} by their volume", removed.by_guards(),
                     removed.by_guards() == 1 ? "" : "s", removed.not_finite, removed.volume);
}

}  // namespace thawslide::sim
