// Temperature and pore pressure of a node, from sums over particles. For host and device. Nodes: access to their
// records (mpm/nodes.hpp, device/node_access.hpp).
#pragma once

#include "band/heat_face.hpp"
#include "base/portability.hpp"
#include "mpm/records.hpp"

namespace thawslide::band {

// Averages (Eq. 21). A prescribed temperature is set before gradients are computed.
template <int Dim, class Nodes>
struct SetState {
  using Totals = mpm::NoTotals;

  Nodes nodes;
  HeatFaces<Dim> faces;
  bool has_faces;

  template <class Node>
  THAWSLIDE_HD void operator()(const Node& node, Totals& /*totals*/) const {
    using mpm::Averages, mpm::NodalState;
    const double* averages = nodes.template read<Averages>(node);
    double* state = nodes.template write<NodalState>(node);
    for (std::size_t c = 0; c < mpm::record_size(NodalState::template size<Dim>); ++c) {
      state[c] = 0.0;
    }
    if (!(averages[Averages::volume] > 0.0)) {
      return;
    }
    const double inverse_volume = 1.0 / averages[Averages::volume];
    state[NodalState::temperature] = averages[Averages::temperature] * inverse_volume;
    state[NodalState::pore_pressure] = averages[Averages::pore_pressure] * inverse_volume;
    if (has_faces) {
      prescribe_temperature(faces.at(nodes.position(node)), state);
    }
  }
};

// Pore pressure of the seeping water [Pa].
template <class Nodes>
struct SetSeepingPressure {
  using Totals = mpm::NoTotals;

  Nodes nodes;

  template <class Node>
  THAWSLIDE_HD void operator()(const Node& node, Totals& /*totals*/) const {
    const double* water = nodes.template read<mpm::SeepingWater>(node);
    const double volume = water[mpm::SeepingWater::volume];
    nodes.template write<mpm::NodalState>(node)[mpm::NodalState::pore_pressure] =
        volume > 0.0 ? water[mpm::SeepingWater::pore_pressure] / volume : 0.0;
  }
};

}  // namespace thawslide::band
