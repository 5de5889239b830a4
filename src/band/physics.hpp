// What a particle's heat and pore pressure depend on, in plain numbers: all that kernels need to know of the run.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/portability.hpp"
#include "physics/mixture.hpp"

namespace thawslide::band {

template <class Real>
struct BandPhysics {
  physics::Phases<Real> phases;
  Real reference_temperature = 0;  // Tref [C]
  Real clapeyron_sign = 1;         // +1 as usual, -1 as Eq. 4 prints it
  Real gravity = 0;                // magnitude [m/s2]
  bool conduction = true;
  bool advection = true;
  bool thermal_pressurization = true;
  bool volumetric_term = false;  // Eq. 8's -div v, which Eq. 23 drops
  bool seepage = true;
  bool seepage_as_printed = false;  // Eq. 23 with one xi over the whole pore space
  bool thickness_each_step = true;
};

// Hydraulic conductivities [m/s] of particles, by their material.
template <class Real>
struct HydraulicConductivity {
  const Real* of_material;
  bool is_uniform;  // of_material has one number, for all

  template <class Particles, class At>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE typename At::Value operator()(const Particles& particles,
                                                                                   const At& at) const {
    if (is_uniform) {
      return of_material[0];
    }
    return at.each([&](std::uint32_t p) { return of_material[static_cast<std::size_t>(particles.material(p))]; });
  }
};

}  // namespace thawslide::band
