// Particles that are invalid, or have left the domain or the known terrain: they end the run, or are removed and
// counted, as specified by the case.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <vector>

#include "band/body_sums.hpp"
#include "mpm/kernel_totals.hpp"
#include "sim/solver/budget.hpp"
#include "sim/solver/slide.hpp"

namespace thawslide::sim {

// Number of particles removed from a run, by cause.
struct Removed {
  std::int64_t left = 0, not_finite = 0, volume = 0;

  [[nodiscard]] std::int64_t by_guards() const { return not_finite + volume; }
  [[nodiscard]] std::int64_t all() const { return left + by_guards(); }
  Removed& operator+=(const Removed& more) {
    left += more.left;
    not_finite += more.not_finite;
    volume += more.volume;
    return *this;
  }
};

// Text such as "12 particles: 3 not finite, 9 by their volume" for particles removed by guards.
[[nodiscard]] inline std::string text_of(const Removed& removed) {
  return fmt::format("{} particle{}: {} not finite, {} by their volume", removed.by_guards(),
                     removed.by_guards() == 1 ? "" : "s", removed.not_finite, removed.volume);
}

// Reason for removal of a particle.
enum Mark : std::uint8_t { stays, has_left, is_not_finite, has_inverted };

using Marks = std::vector<std::uint8_t>;

// Marks the invalid particles that are to be removed; no marks if there is none. Sets `invalid` to a particle that must
// end the run.
template <int Dim>
void mark_invalid(const config::Guards& guards, const mpm::Particles<Dim>& particles, Marks& marks,
                  mpm::InvalidParticle& invalid);
// Adds the particles that have left. all_tiles: also checks tiles whose own block is above known ground.
template <int Dim>
void mark_left(const Setup<Dim>& setup, const Slide<Dim>& slide, bool all_tiles, Marks& marks,
               mpm::InvalidParticle& invalid);
[[nodiscard]] Removed count_of(const Marks& marks);

// Adds the budget terms of the marked particles. before: budget before the step; of_particle: contribution to sums.
template <int Dim>
void add_removed(const Setup<Dim>& setup, const Slide<Dim>& slide, const Marks& marks, const Budget<Dim>& before,
                 const band::SumsOfParticle<Dim>& of_particle, Budget<Dim>& budget);

// Fault of the particle with the smallest id among those marked as invalid.
template <int Dim>
[[nodiscard]] mpm::InvalidParticle first_invalid(const config::Guards& guards, const mpm::Particles<Dim>& particles,
                                                 const Marks& marks);

// Sums over marked particles.
template <int Dim>
[[nodiscard]] band::BodySums<Dim> sum_over_marked(const Slide<Dim>& slide, const band::SumsOfParticle<Dim>& of_particle,
                                                  const Marks& marks);

}  // namespace thawslide::sim
