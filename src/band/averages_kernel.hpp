// What a particle does in average_on_grid: kernels (mpm/kernel.hpp).
#pragma once

#include "band/physics.hpp"
#include "base/portability.hpp"
#include "base/select.hpp"
#include "mpm/records.hpp"

namespace thawslide::band {

// The sums of Eq. 21.
template <int Dim, class Real>
struct AddAverages {
  using Reads = mpm::RecordList<>;
  using Adds = mpm::RecordList<mpm::Averages>;
  using Account = mpm::NoAccount;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(const Particles& particles, const At& at, const Seen& /*seen*/,
                                                       Scatter& added, Account& /*account*/) const {
    const auto volume = particles.volume.load(at);
    auto& averages = added.template of<mpm::Averages>();
    averages.value[mpm::Averages::volume] = volume;
    averages.value[mpm::Averages::temperature] = volume * particles.temperature.load(at);
    averages.value[mpm::Averages::pore_pressure] = volume * particles.pore_pressure.load(at);
  }
};

// Whether water seeps from and to a particle: it is melted and lets water through.
template <class Real, class Particles, class At>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE auto seeps(const BandPhysics<Real>& model,
                                                const HydraulicConductivity<Real>& hydraulic,
                                                const Particles& particles, const At& at) {
  return (particles.temperature.load(at) >= model.reference_temperature) & (hydraulic(particles, at) > Real(0));
}

// The sums of Eq. 21 over the pores that take part in seepage, where frozen ones do not, or count as empty: sealed or
// vented. What is averaged over other pores than those that store would be no mean of what they hold.
template <int Dim, class Real>
struct AddSeepingWater {
  using Reads = mpm::RecordList<>;
  using Adds = mpm::RecordList<mpm::SeepingWater>;
  using Account = mpm::NoAccount;

  const BandPhysics<Real>& model;
  HydraulicConductivity<Real> hydraulic;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(const Particles& particles, const At& at, const Seen& /*seen*/,
                                                       Scatter& added, Account& /*account*/) const {
    using Value = typename At::Value;
    const Value volume = particles.volume.load(at), zero = Real(0);
    const auto seeping = seeps(model, hydraulic, particles, at);
    const auto takes_part = model.frozen_rows == FrozenRows::sealed ? seeping : hydraulic(particles, at) > Real(0);
    auto& water = added.template of<mpm::SeepingWater>();
    water.value[mpm::SeepingWater::volume] = select(takes_part, volume, zero);
    water.value[mpm::SeepingWater::pore_pressure] = select(seeping, volume * particles.pore_pressure.load(at), zero);
  }
};

}  // namespace thawslide::band
