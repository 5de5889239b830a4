// Heat content of a particle per volume at t = 0, and its derivatives: Eq. 9 with the masses of the formulation. The
// factor V0/xi, the volume that heat acts on, is not included.
#pragma once

#include <type_traits>

#include "base/portability.hpp"

namespace thawslide::band {

// Rock, ice and water at t = 0.
struct InitialMasses {
  template <class Particles, class At>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE static auto porosity(const Particles& particles, const At& at) {
    return particles.initial_porosity.load(at);
  }
  template <class Particles, class At>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE static typename At::Value volume_ratio(const Particles& /*particles*/,
                                                                              const At& /*at*/) {
    return typename At::Value(1);
  }
};

// Masses from the current porosity and volume, as published.
struct CurrentMasses {
  template <class Particles, class At>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE static auto porosity(const Particles& particles, const At& at) {
    return particles.porosity.load(at);
  }
  template <class Particles, class At>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE static auto volume_ratio(const Particles& particles, const At& at) {
    return particles.volume.load(at) / particles.initial_volume.load(at);
  }
};

template <class Content, class Masses>
struct ParticleHeat {
  static constexpr bool masses_change = std::is_same_v<Masses, CurrentMasses>;

  Content content;

  // H [J/m3] at the particle's temperature.
  template <class Particles, class At>
  [[nodiscard]] THAWSLIDE_HD auto heat(const Particles& particles, const At& at) const {
    return Masses::volume_ratio(particles, at) *
           content.content(particles.temperature.load(at), Masses::porosity(particles, at));
  }
  // dH/dT [J/m3/K] at the particle's temperature.
  template <class Particles, class At>
  [[nodiscard]] THAWSLIDE_HD auto tangent(const Particles& particles, const At& at) const {
    return Masses::volume_ratio(particles, at) *
           content.apparent_capacity(particles.temperature.load(at), Masses::porosity(particles, at));
  }
  // (H(T + change) - H(T))/change [J/m3/K].
  template <class Particles, class At, class Value>
  [[nodiscard]] THAWSLIDE_HD Value secant(const Particles& particles, const At& at, const Value& change) const {
    return Masses::volume_ratio(particles, at) *
           content.secant_capacity(particles.temperature.load(at), change, Masses::porosity(particles, at));
  }
  // Temperature [C] at a heat content [J/m3]. guess: initial value of the iteration.
  template <class Particles, class At, class Value>
  [[nodiscard]] THAWSLIDE_HD Value temperature(const Particles& particles, const At& at, const Value& heat,
                                               const Value& guess) const {
    return content.temperature(Value(heat / Masses::volume_ratio(particles, at)),
                               Value(Masses::porosity(particles, at)), guess);
  }
};

}  // namespace thawslide::band
