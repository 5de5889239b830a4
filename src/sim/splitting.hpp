// Fields used for splitting stretched particles (mpm/splitting.hpp).
#pragma once

#include <cstddef>

#include "mpm/particles.hpp"
#include "mpm/splitting.hpp"

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

}  // namespace thawslide::sim
