// Nodal part of conduct_heat (Eq. 19) for one node, and its sums. For host and device.
#pragma once

#include <cstdint>

#include "base/portability.hpp"
#include "mpm/records.hpp"

namespace thawslide::band {

// Heat gained by the body in one step [J], by source.
struct HeatGain {
  double friction = 0;
  double boundary = 0;
  double advection = 0;
  double capacity = 0;  // created by updating with the old apparent capacity
  double porosity = 0;  // created by masses from the current porosity and volume

  THAWSLIDE_HD HeatGain& operator+=(const HeatGain& part) {
    friction += part.friction;
    boundary += part.boundary;
    advection += part.advection;
    capacity += part.capacity;
    porosity += part.porosity;
    return *this;
  }
};

// Sums over nodes.
struct NodalHeat {
  HeatGain gain;
  std::uint64_t unreached_nodes = 0;  // nodes with heat but without linear weight

  THAWSLIDE_HD NodalHeat& operator+=(const NodalHeat& part) {
    gain += part.gain;
    unreached_nodes += part.unreached_nodes;
    return *this;
  }
};

// Temperature rate [K/s] of a node with a heat capacity [J/K], the particles' gain by subgrid diffusion [J] and
// friction heat [W]. rates, momentum: records of HeatRates and Momentum. unreached: friction heat per mass [W/kg] if
// the node has no linear weight. meets_face(rate, power): true if a face condition has set the rate; it may add to the
// power [W].
template <int Dim, class Rates, class MomentumRecord, class MeetsFace>
THAWSLIDE_HD void solve_temperature_rate(const Rates& rates, double capacity, double subgrid, double friction,
                                         const MomentumRecord& momentum, double dt, double& rate, double& unreached,
                                         NodalHeat& sum, const MeetsFace& meets_face) {
  using mpm::HeatRates;
  rate = unreached = 0.0;
  sum.gain.friction += dt * friction;
  if (!(capacity > 0.0)) {
    if (friction > 0.0) {
      unreached = friction / momentum[mpm::MomentumLayout<Dim>::mass];
      ++sum.unreached_nodes;
    }
    return;
  }
  double power = rates[HeatRates::conduction] + rates[HeatRates::advection] + friction - subgrid * (1.0 / dt);
  sum.gain.advection += dt * rates[HeatRates::advection];
  if (!meets_face(rate, power)) {
    rate = power / capacity;
  }
}

}  // namespace thawslide::band
