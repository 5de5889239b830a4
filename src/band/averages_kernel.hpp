// Particle kernels (mpm/kernel.hpp) of average_on_grid.
#pragma once

#include "band/physics.hpp"
#include "base/portability.hpp"
#include "base/select.hpp"
#include "mpm/records.hpp"

namespace thawslide::band {

// Sums of Eq. 21.
template <int Dim>
struct AddAverages {
  using Reads = mpm::RecordList<>;
  using Adds = mpm::RecordList<mpm::Averages>;
  using Totals = mpm::NoTotals;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(const Particles& particles, const At& at, const Seen& /*seen*/,
                                                       Scatter& added, Totals& /*totals*/) const {
    const auto volume = particles.volume.load(at);
    auto& averages = added.template of<mpm::Averages>();
    averages.value[mpm::Averages::volume] = volume;
    averages.value[mpm::Averages::temperature] = volume * particles.temperature.load(at);
    averages.value[mpm::Averages::pore_pressure] = volume * particles.pore_pressure.load(at);
  }
};

// True if water seeps to or from a particle: it is melted and permeable.
template <class Particles, class At>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE auto seeps(const BandPhysics& model, const HydraulicConductivity& hydraulic,
                                                const Particles& particles, const At& at) {
  return (particles.temperature.load(at) >= model.reference_temperature) & (hydraulic(particles, at) > 0.0);
}

// Sums of Eq. 21 over the pores that take part in seepage. Frozen pores are excluded (sealed) or count as empty
// (vented). The average must be over the same pores that store water in SeepageFlows; otherwise it is not the mean of
// the stored water.
template <int Dim>
struct AddSeepingWater {
  using Reads = mpm::RecordList<>;
  using Adds = mpm::RecordList<mpm::SeepingWater>;
  using Totals = mpm::NoTotals;

  BandPhysics model;
  HydraulicConductivity hydraulic;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(const Particles& particles, const At& at, const Seen& /*seen*/,
                                                       Scatter& added, Totals& /*totals*/) const {
    using Value = typename At::Value;
    const Value volume = particles.volume.load(at), zero = 0.0;
    const auto seeping = seeps(model, hydraulic, particles, at);
    const auto participates = model.frozen_rows == FrozenRows::sealed ? seeping : hydraulic(particles, at) > 0.0;
    auto& water = added.template of<mpm::SeepingWater>();
    water.value[mpm::SeepingWater::volume] = select(participates, volume, zero);
    water.value[mpm::SeepingWater::pore_pressure] = select(seeping, volume * particles.pore_pressure.load(at), zero);
  }
};

}  // namespace thawslide::band
