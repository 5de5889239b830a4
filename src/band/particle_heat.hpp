// The heat a particle holds, per volume of t = 0, and what it takes to change it: the heat content of Eq. 9 with the
// masses it counts. What a particle's volume is worth to heat, V0/xi, stays outside.
#pragma once

#include "band/model.hpp"
#include "mpm/particles.hpp"

namespace thawslide::band {

// Rock, ice and water of t = 0.
struct InitialMasses {
  template <int Dim, class Real>
  static Lanes<Real> porosity(const mpm::Particles<Dim, Real>& particles, const mpm::Batch<Real>& batch) {
    return particles.initial_porosity.load(batch);
  }
  template <int Dim, class Real>
  static Lanes<Real> volume_ratio(const mpm::Particles<Dim, Real>& /*particles*/, const mpm::Batch<Real>& /*batch*/) {
    return Real(1);
  }
};

// All from the current porosity and volume, as printed.
struct CurrentMasses {
  template <int Dim, class Real>
  static Lanes<Real> porosity(const mpm::Particles<Dim, Real>& particles, const mpm::Batch<Real>& batch) {
    return particles.porosity.load(batch);
  }
  template <int Dim, class Real>
  static Lanes<Real> volume_ratio(const mpm::Particles<Dim, Real>& particles, const mpm::Batch<Real>& batch) {
    return particles.volume.load(batch) / particles.initial_volume.load(batch);
  }
};

// Of the particles of a batch, by lane.
template <int Dim, class Real, class Content, class Masses>
struct ParticleHeat {
  const mpm::Particles<Dim, Real>& particles;
  const Content& content;

  // H [J/m3] at the particle's temperature.
  [[nodiscard]] Lanes<Real> heat(const mpm::Batch<Real>& batch) const {
    return ratio(batch) * content.content(particles.temperature.load(batch), porosity(batch));
  }
  // dH/dT [J/m3/K] there.
  [[nodiscard]] Lanes<Real> tangent(const mpm::Batch<Real>& batch) const {
    return ratio(batch) * content.apparent_capacity(particles.temperature.load(batch), porosity(batch));
  }
  // (H(T + change) - H(T))/change [J/m3/K].
  [[nodiscard]] Lanes<Real> secant(const mpm::Batch<Real>& batch, Lanes<Real> change) const {
    return ratio(batch) * content.secant_capacity(particles.temperature.load(batch), change, porosity(batch));
  }
  // Temperature [C] at which the particle holds `heat` [J/m3], from a guess near it.
  [[nodiscard]] Lanes<Real> temperature(const mpm::Batch<Real>& batch, Lanes<Real> heat, Lanes<Real> guess) const {
    return content.temperature(heat / ratio(batch), porosity(batch), guess);
  }

 private:
  [[nodiscard]] Lanes<Real> porosity(const mpm::Batch<Real>& batch) const { return Masses::porosity(particles, batch); }
  [[nodiscard]] Lanes<Real> ratio(const mpm::Batch<Real>& batch) const {
    return Masses::volume_ratio(particles, batch);
  }
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
