// Temperature rate of a node (Eq. 19) in a step, and its sums. For host and device.
#pragma once

#include <cstdint>

#include "band/heat_face.hpp"
#include "base/portability.hpp"
#include "mpm/records.hpp"

namespace thawslide::band {

// Heat gained by the nodes in one step [J], by source.
struct NodalGain {
  double friction = 0;
  double boundary = 0;
  double advection = 0;
};
// Heat gained by the body in one step [J].
struct HeatGain : NodalGain {
  double capacity = 0;  // created by updating with the old apparent capacity
};

// Sums over nodes.
struct NodalHeat {
  NodalGain gain;
  std::uint64_t unreached_nodes = 0;  // nodes with heat but without linear weight

  THAWSLIDE_HD NodalHeat& operator+=(const NodalHeat& part) {
    gain.friction += part.gain.friction;
    gain.boundary += part.gain.boundary;
    gain.advection += part.gain.advection;
    unreached_nodes += part.unreached_nodes;
    return *this;
  }
};

// Solves for the rate from sums with the tangent capacity, or with the secant capacity in marked blocks. Nodes without
// linear weight store their friction heat per mass. Nodes: as in band/nodal_state.hpp.
template <int Dim, class Nodes>
struct SolveRates {
  using Totals = NodalHeat;

  Nodes nodes;
  const std::uint8_t* secant_blocks;  // null: none
  double dt, cell;
  HeatFaces<Dim> faces;
  bool has_faces;
  bool first_step;  // prescribed temperatures are applied as a jump

  template <class Node>
  THAWSLIDE_HD void operator()(const Node& node, NodalHeat& sum) const {
    using mpm::HeatRates;
    const double* tangent = nodes.template read<HeatRates>(node);
    const bool has_secant = secant_blocks != nullptr && secant_blocks[nodes.block(node)] != 0;
    const double* rates = has_secant ? nodes.template read<mpm::SecantRates>(node) : tangent;
    const double capacity = rates[HeatRates::capacity];
    const double friction = nodes.template read<mpm::Contact>(node)[mpm::Contact::friction_heat];
    double* unreached = nodes.template write<mpm::UnreachedHeat>(node);  // null only without contact
    double& rate = nodes.template write<mpm::NodalState>(node)[mpm::NodalState::temperature_rate];
    rate = 0.0;
    if (unreached != nullptr) {
      unreached[0] = 0.0;
    }
    sum.gain.friction += dt * friction;
    if (!(capacity > 0.0)) {
      if (friction > 0.0) {
        unreached[0] = friction / nodes.template read<mpm::Momentum>(node)[mpm::MomentumLayout<Dim>::mass];
        ++sum.unreached_nodes;
      }
      return;
    }
    double power = tangent[HeatRates::conduction] + tangent[HeatRates::advection] + friction -
                   rates[HeatRates::subgrid] * (1.0 / dt);
    sum.gain.advection += dt * tangent[HeatRates::advection];
    if (!has_faces || !meets_face(faces.at(nodes.position(node)), first_step, nodes.template read<mpm::Averages>(node),
                                  capacity, cell, dt, rate, power, sum.gain.boundary)) {
      rate = power / capacity;
    }
  }
};

}  // namespace thawslide::band
