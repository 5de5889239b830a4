// Heat content of a particle per volume at t = 0, and its derivatives: Eq. 9 with the masses of rock, ice and water at
// t = 0. The factor V0/xi, the volume that heat acts on, is not included.
#pragma once

#include "base/portability.hpp"

namespace thawslide::band {

template <class Content>
struct ParticleHeat {
  Content content;

  // H [J/m3] at the particle's temperature.
  template <class Particles, class At>
  [[nodiscard]] THAWSLIDE_HD auto heat(const Particles& particles, const At& at) const {
    return content.content(particles.temperature.load(at), particles.initial_porosity.load(at));
  }
  // dH/dT [J/m3/K] at the particle's temperature.
  template <class Particles, class At>
  [[nodiscard]] THAWSLIDE_HD auto tangent(const Particles& particles, const At& at) const {
    return content.apparent_capacity(particles.temperature.load(at), particles.initial_porosity.load(at));
  }
  // (H(T + change) - H(T))/change [J/m3/K].
  template <class Particles, class At, class Value>
  [[nodiscard]] THAWSLIDE_HD Value secant(const Particles& particles, const At& at, const Value& change) const {
    return content.secant_capacity(particles.temperature.load(at), change, particles.initial_porosity.load(at));
  }
  // Temperature [C] at a heat content [J/m3]. guess: initial value of the iteration.
  template <class Particles, class At, class Value>
  [[nodiscard]] THAWSLIDE_HD Value temperature(const Particles& particles, const At& at, const Value& heat,
                                               const Value& guess) const {
    return content.temperature(heat, particles.initial_porosity.load(at), guess);
  }
};

}  // namespace thawslide::band
