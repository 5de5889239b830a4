// The heat a particle holds, per volume of t = 0, and what it takes to change it: the heat content of Eq. 9 with the
// masses it counts. What a particle's volume is worth to heat, V0/xi, stays outside.
#pragma once

#include "band/model.hpp"
#include "mpm/particles.hpp"

namespace thawslide::band {

// Rock, ice and water of t = 0.
struct InitialMasses {
  template <int Dim, class Real>
  static Real porosity(const mpm::Particles<Dim, Real>& particles, std::size_t p) {
    return particles.initial_porosity(p);
  }
  template <int Dim, class Real>
  static Real volume_ratio(const mpm::Particles<Dim, Real>& /*particles*/, std::size_t /*p*/) {
    return Real(1);
  }
};

// All from the current porosity and volume, as printed.
struct CurrentMasses {
  template <int Dim, class Real>
  static Real porosity(const mpm::Particles<Dim, Real>& particles, std::size_t p) {
    return particles.porosity(p);
  }
  template <int Dim, class Real>
  static Real volume_ratio(const mpm::Particles<Dim, Real>& particles, std::size_t p) {
    return particles.volume(p) / particles.initial_volume(p);
  }
};

template <int Dim, class Real, class Content, class Masses>
struct ParticleHeat {
  const mpm::Particles<Dim, Real>& particles;
  const Content& content;

  // H [J/m3] at the particle's temperature.
  [[nodiscard]] Real heat(std::size_t p) const {
    return ratio(p) * content.content(particles.temperature(p), porosity(p));
  }
  // dH/dT [J/m3/K] there.
  [[nodiscard]] Real tangent(std::size_t p) const {
    return ratio(p) * content.apparent_capacity(particles.temperature(p), porosity(p));
  }
  // (H(T + change) - H(T))/change [J/m3/K].
  [[nodiscard]] Real secant(std::size_t p, Real change) const {
    return ratio(p) * content.secant_capacity(particles.temperature(p), change, porosity(p));
  }
  // Temperature [C] at which the particle holds `heat` [J/m3], from a guess near it.
  [[nodiscard]] Real temperature(std::size_t p, Real heat, Real guess) const {
    return content.temperature(heat / ratio(p), porosity(p), guess);
  }

 private:
  [[nodiscard]] Real porosity(std::size_t p) const { return Masses::porosity(particles, p); }
  [[nodiscard]] Real ratio(std::size_t p) const { return Masses::volume_ratio(particles, p); }
};

// Calls work(law) with the ParticleHeat of the run.
template <int Dim, class Real, class Work>
decltype(auto) with_particle_heat(const BandModel<Dim, Real>& model, const mpm::Particles<Dim, Real>& particles,
                                  const Work& work) {
  return model.with_heat_content([&](const auto& content) {
    using Content = std::decay_t<decltype(content)>;
    if (model.current_masses) {
      return work(ParticleHeat<Dim, Real, Content, CurrentMasses>{particles, content});
    }
    return work(ParticleHeat<Dim, Real, Content, InitialMasses>{particles, content});
  });
}

}  // namespace thawslide::band
