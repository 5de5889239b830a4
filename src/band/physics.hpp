// Parameters of heat and pore pressure at particles, as plain numbers for kernels.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

#include "base/portability.hpp"
#include "physics/freezing.hpp"
#include "physics/heat_content.hpp"
#include "physics/mixture.hpp"
#include "physics/options.hpp"
#include "physics/pore_water.hpp"

namespace thawslide::band {

// Heat content laws available to a run, by freezing curve.
using AnyHeatContent =
    std::variant<physics::HeatContent<physics::PowerLawCurve>, physics::HeatContent<physics::LinearCurve>>;

using physics::FrozenRows;

struct BandPhysics {
  physics::Phases phases;
  double reference_temperature = 0;  // Tref [C]
  double gravity = 0;                // magnitude [m/s2]
  bool conduction = true;
  bool advection = true;
  bool thermal_pressurization = true;
  bool volumetric_term = false;  // -div v in Eq. 8, which Eq. 23 drops
  bool seepage = true;
  bool thickness_each_step = true;
  FrozenRows frozen_rows = FrozenRows::draining;
  bool ice_presses = true;              // P is that of ice and liquid while frozen; off: 0
  bool melt_contracts = false;          // melting leaves a void
  double residual_stress = 0;           // s0, on thawing if ice does not press [Pa]
  double skeleton_compressibility = 0;  // m_v [1/Pa]
  physics::WaterExpansion water;        // beta_L
  bool conservative_advection = false;  // advected heat is a flux; off: rho_L C_L q.grad T, as in Eq. 9
  bool rescaling_mixes = false;         // a thickening band takes in material in its state at t = 0

  // True if the water balance of pores is used (physics/pore_water.hpp) instead of Eq. 23 as published.
  [[nodiscard]] THAWSLIDE_HD bool balances_water() const {
    return !ice_presses || melt_contracts || skeleton_compressibility > 0.0 ||
           water.law != physics::WaterExpansionLaw::constant;
  }
  // True if particles need the normal load N.
  [[nodiscard]] bool needs_normal_load() const { return !ice_presses || skeleton_compressibility > 0.0; }
};

// True if water may seep anywhere. hydraulic_conductivity: by material [m/s].
inline bool water_may_seep(const BandPhysics& model, const std::vector<double>& hydraulic_conductivity) {
  return model.seepage && model.thermal_pressurization &&
         std::any_of(hydraulic_conductivity.begin(), hydraulic_conductivity.end(), [](double k) { return k > 0.0; });
}

// Hydraulic conductivity [m/s] of particles, by material.
struct HydraulicConductivity {
  const double* of_material;
  bool is_uniform;  // one value for all materials

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
