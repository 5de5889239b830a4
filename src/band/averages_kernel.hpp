// What a particle does in average_on_grid: a kernel (mpm/kernel.hpp).
#pragma once

#include "base/portability.hpp"
#include "mpm/records.hpp"

namespace thawslide::band {

// The sums of Eq. 21.
template <int Dim, class Real>
struct AddAverages {
  using Reads = mpm::RecordList<>;
  using Adds = mpm::RecordList<mpm::Averages>;
  using Account = mpm::NoAccount;

  template <class Particles, class At, class Seen, class Added>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(const Particles& particles, const At& at, const Seen& /*seen*/,
                                                       Added& added, Account& /*account*/) const {
    const auto volume = particles.volume.load(at);
    auto& averages = added.template of<mpm::Averages>();
    averages.value[mpm::Averages::volume] = volume;
    averages.value[mpm::Averages::temperature] = volume * particles.temperature.load(at);
    averages.value[mpm::Averages::pore_pressure] = volume * particles.pore_pressure.load(at);
  }
};

}  // namespace thawslide::band
