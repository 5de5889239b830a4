// Mass of the sliding mass and its first moments, around the origin of particle positions.
#pragma once

#include <cstdint>

#include "base/portability.hpp"

namespace thawslide::mpm {

struct MassMoments {
  double mass = 0.0, mass_x = 0.0, mass_y = 0.0;  // [kg, kg m]

  THAWSLIDE_HD MassMoments& operator+=(const MassMoments& part) {
    mass += part.mass;
    mass_x += part.mass_x;
    mass_y += part.mass_y;
    return *this;
  }
};

struct MomentsOfParticle {
  using Sums = MassMoments;

  template <class Particles>
  [[nodiscard]] THAWSLIDE_HD MassMoments operator()(const Particles& particles, std::uint32_t p) const {
    return {particles.mass(p), particles.mass(p) * particles.position(p, 0),
            particles.mass(p) * particles.position(p, 1)};
  }
};

}  // namespace thawslide::mpm
