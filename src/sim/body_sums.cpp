// Sums over the particles of a run: energies, masses, momentum.
#include <algorithm>

#include "base/instances.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

namespace {

// Masses of rock, ice and water in a particle [kg].
template <class Real>
struct PhaseMasses {
  Real rock, ice, water;
};

// The saturation that a particle's masses are counted with. Heat sees the volume V/xi of it, the band's own, and only
// that has melted: the rest stands for matter as it was at t = 0.
template <int Dim, class Real>
Real saturation_of_masses(const mpm::Particles<Dim, Real>& particles, std::uint32_t p) {
  const Real start = particles.initial_saturation(p);
  return start + (particles.liquid_saturation(p) - start) / particles.thermal_scaling(p);
}

// Those of t = 0, of which ice and water change into each other at constant sum.
template <int Dim, class Real>
PhaseMasses<Real> initial_masses(const mpm::Particles<Dim, Real>& particles, const physics::Phases<Real>& phases,
                                 std::uint32_t p) {
  const Real start = particles.initial_saturation(p), saturation = saturation_of_masses(particles, p);
  const Real pore_water = particles.initial_volume(p) * particles.initial_porosity(p) *
                          (phases.water_density * start + phases.ice_density * (Real(1) - start));
  return {particles.mass(p) - pore_water, (Real(1) - saturation) * pore_water, saturation * pore_water};
}

// Those of the current porosity and volume, as printed: their sum is not the particle's mass.
template <int Dim, class Real>
PhaseMasses<Real> current_masses(const mpm::Particles<Dim, Real>& particles, const physics::Phases<Real>& phases,
                                 std::uint32_t p) {
  const Real pore = particles.volume(p) * particles.porosity(p), saturation = saturation_of_masses(particles, p);
  return {(particles.volume(p) - pore) * phases.rock_density, pore * (Real(1) - saturation) * phases.ice_density,
          pore * saturation * phases.water_density};
}

// Void in the pores of a particle's own part of the band [m3]; what is still frozen leaves less of it than its water.
template <int Dim, class Real>
Real void_in_pores(const band::BandModel<Dim, Real>& band, const mpm::Particles<Dim, Real>& particles,
                   std::uint32_t p) {
  if (!particles.pore_void.is_kept()) {
    return Real(0);
  }
  const Real frozen = band.melt_contracts ? physics::melting_void(band.phases, particles.initial_porosity(p),
                                                                  Real(1) - particles.liquid_saturation(p))
                                          : Real(0);
  return std::max(particles.pore_void(p) - frozen, Real(0)) * particles.volume(p) / particles.thermal_scaling(p);
}

}  // namespace

template <int Dim, class Real>
BodySums<Dim, Real> sum_over_body(const Simulation<Dim, Real>& simulation, const std::vector<std::uint8_t>* marked) {
  const auto& particles = simulation.particles();
  const auto& model = simulation.model();
  const physics::Phases<Real>& phases = model.motion.phases;
  const bool current = model.band.current_masses;
  BodySums<Dim, Real> sums;
  for (const std::uint32_t p : simulation.grid().order()) {
    if (marked != nullptr && (*marked)[p] == 0) {
      continue;
    }
    const Real mass = particles.mass(p);
    for (int a = 0; a < Dim; ++a) {
      sums.momentum[a] += mass * particles.velocity(p, a);
      sums.kinetic += Real(0.5) * mass * particles.velocity(p, a) * particles.velocity(p, a);
      sums.potential -=
          mass * model.motion.gravity[a] * (particles.position(p, a) + static_cast<Real>(model.origin[a]));
    }
    const Real pore = current ? particles.volume(p) * particles.porosity(p)
                              : particles.initial_volume(p) * particles.initial_porosity(p);
    const Real latent = simulation.parameters().heat.latent
                            ? phases.ice_density * pore * phases.latent_heat * particles.liquid_saturation(p)
                            : Real(0);
    sums.latent += latent / particles.thermal_scaling(p);
    sums.sensible += (particles.initial_volume(p) * particles.heat_content(p) - latent) / particles.thermal_scaling(p);
    const PhaseMasses<Real> masses =
        current ? current_masses(particles, phases, p) : initial_masses(particles, phases, p);
    sums.mass += mass;
    sums.rock += masses.rock;
    sums.ice += masses.ice;
    sums.water += masses.water;
    sums.seeped += particles.seeped_water.is_kept() ? particles.seeped_water(p) : Real(0);
    sums.gas += void_in_pores(model.band, particles, p);
  }
  return sums;
}

#define THAWSLIDE_INSTANTIATE(Dim, Real) \
  template BodySums<Dim, Real> sum_over_body<Dim, Real>(const Simulation<Dim, Real>&, const std::vector<std::uint8_t>*);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
