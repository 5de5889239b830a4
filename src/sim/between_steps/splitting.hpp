// Splitting of particles that have been stretched along the ground (mpm/splitting.hpp), between two steps.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "mpm/particles.hpp"
#include "mpm/splitting.hpp"
#include "sim/setup/model.hpp"
#include "sim/solver/slide.hpp"

namespace thawslide::sim {

template <int Dim>
void keep_split_fields(bool kept, mpm::Particles<Dim>& particles) {
  particles.surface_stretch.keep(kept);
  particles.parent_id.keep(kept);
}

// Sets the stretch to 1 and the parent to the particle itself, for particles at memory index `first` and above.
template <int Dim>
void set_unsplit(mpm::Particles<Dim>& particles, std::size_t first = 0) {
  for (std::size_t p = first; particles.surface_stretch.is_kept() && p < particles.size(); ++p) {
    mpm::set_surface_stretch<Dim>(particles, p, mpm::SurfaceStretch<Dim>::Identity());
    particles.parent_id(p) = particles.id(p);
  }
}

inline constexpr std::int64_t split_interval = 10;  // steps between checks

// Particle that is split in two, and half of the way between its halves.
template <int Dim>
struct Split {
  std::size_t particle = 0;  // in memory
  std::array<Vector<double, Dim>, 2> positions;
  Vector<double, Dim - 1> direction;  // along which it is halved

  [[nodiscard]] Vector<double, Dim> half_way() const { return 0.5 * (positions[1] - positions[0]); }
};

// Particles to be split, by id. The limit admits those of smallest id.
template <int Dim>
[[nodiscard]] std::vector<Split<Dim>> splits_due(const Setup<Dim>& setup, const Slide<Dim>& slide);

// Splits particles; the new ones are last in memory. Adds the energy gained to `energy` [J].
template <int Dim>
void split(const Setup<Dim>& setup, const std::vector<Split<Dim>>& due, Slide<Dim>& slide, double& energy);

// Warning that mechanics.split_limit prevents further splitting; empty if it does not.
template <int Dim>
[[nodiscard]] std::string split_warning(const Setup<Dim>& setup, const Slide<Dim>& slide, double time);

}  // namespace thawslide::sim
