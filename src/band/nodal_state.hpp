// Nodal temperature and pore pressure from the averages (Eq. 21). For host and device.
#pragma once

#include "base/portability.hpp"
#include "mpm/records.hpp"

namespace thawslide::band {

// averages, state: records of Averages and NodalState. Returns false, with a state of 0, if no particle is near.
template <int Dim, class Averaged, class State>
THAWSLIDE_HD bool set_nodal_state(const Averaged& averages, State& state) {
  using mpm::Averages, mpm::NodalState;
  for (std::size_t c = 0; c < mpm::record_size(NodalState::template size<Dim>); ++c) {
    state[c] = Real(0);
  }
  if (!(averages[Averages::volume] > Real(0))) {
    return false;
  }
  const Real inverse_volume = Real(1) / averages[Averages::volume];
  state[NodalState::temperature] = averages[Averages::temperature] * inverse_volume;
  state[NodalState::pore_pressure] = averages[Averages::pore_pressure] * inverse_volume;
  return true;
}

}  // namespace thawslide::band
