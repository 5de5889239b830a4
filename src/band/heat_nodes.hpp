// What nodes do in conduct_heat: their state from the averages, and their rate of temperature.
#pragma once

#include <algorithm>
#include <iterator>

#include "band/heat.hpp"
#include "band/nodal_state.hpp"
#include "mpm/node_pass.hpp"

namespace thawslide::band {

template <int Dim, class Real>
bool any_face_condition(const BandModel<Dim, Real>& model) {
  return std::any_of(std::begin(model.faces), std::end(model.faces),
                     [](const HeatFace<Real>& face) { return face.kind != FaceHeat::insulated; });
}

// The face of the domain a node lies on, if that face has a condition for heat; null otherwise.
template <int Dim, class Real>
const HeatFace<Real>* face_of(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                              const mpm::NodeAt& at) {
  const Vector<Real, Dim> position = mpm::node_position(grid, at.block, at.node);
  for (int a = 0; a < Dim; ++a) {
    const HeatFace<Real>& lower = model.faces[2 * a];
    const HeatFace<Real>& upper = model.faces[2 * a + 1];
    if (lower.kind != FaceHeat::insulated && position[a] <= round_off<Real> * model.extent[a]) {
      return &lower;
    }
    if (upper.kind != FaceHeat::insulated && position[a] >= model.extent[a] * (Real(1) - round_off<Real>)) {
      return &upper;
    }
  }
  return nullptr;
}

// Temperature and pore pressure of a node (Eq. 21); a prescribed temperature takes its node before gradients are
// formed.
template <int Dim, class Real>
struct SetNodalState {
  const mpm::SparseGrid<Dim, Real>& grid;
  const BandModel<Dim, Real>& model;
  bool has_faces = any_face_condition(model);

  void operator()(mpm::Nodes<Dim, Real>& nodes, const mpm::NodeAt& at) const {
    auto& state = nodes.state(at);
    if (set_nodal_state<Dim, Real>(nodes.averages(at), state)) {
      const HeatFace<Real>* face = has_faces ? face_of(grid, model, at) : nullptr;
      if (face != nullptr && face->kind == FaceHeat::temperature) {
        state[mpm::NodalState::temperature] = face->value;
      }
    }
  }
};

// What comes of some nodes.
template <class Real>
struct NodalHeat {
  HeatGain<Real> gain;
  bool any_orphan = false;  // heat at a node without linear weight

  NodalHeat& operator+=(const NodalHeat& part) {
    gain += part.gain;
    any_orphan = any_orphan || part.any_orphan;
    return *this;
  }
};

// The rate of temperature of a node (Eq. 19) with a heat capacity [J/K] and the heat that particles took by subgrid
// diffusion [J]; friction heat and face conditions come in here. first_step: prescribed temperatures jump now.
template <int Dim, class Real>
struct SolveTemperatureRate {
  const mpm::SparseGrid<Dim, Real>& grid;
  const BandModel<Dim, Real>& model;
  Real dt;
  bool first_step;
  bool has_faces = any_face_condition(model);

  void operator()(mpm::Nodes<Dim, Real>& nodes, const mpm::NodeAt& at, Real capacity, Real subgrid,
                  NodalHeat<Real>& sum) const {
    using mpm::HeatRates;
    const auto& rates = nodes.heat_rates(at);
    const Real friction = nodes.contact(at)[mpm::Contact::friction_heat];
    Real& rate = nodes.state(at)[mpm::NodalState::temperature_rate];
    rate = Real(0);
    if (nodes.orphan_heat.holds(at.block)) {
      nodes.orphan_heat.of_block(at.block)[at.node][0] = Real(0);
    }
    sum.gain.friction += dt * friction;
    if (!(capacity > Real(0))) {
      if (friction > Real(0)) {
        nodes.orphan_heat.of_block(at.block)[at.node][0] =
            friction / nodes.momentum(at)[mpm::MomentumLayout<Dim>::mass];
        sum.any_orphan = true;
      }
      return;
    }
    Real power = rates[HeatRates::conduction] + rates[HeatRates::advection] + friction - subgrid * (Real(1) / dt);
    sum.gain.advection += dt * rates[HeatRates::advection];
    const HeatFace<Real>* face = has_faces ? face_of(grid, model, at) : nullptr;
    if (face != nullptr && face->kind == FaceHeat::temperature) {
      const auto& averages = nodes.averages(at);
      const Real mapped = averages[mpm::Averages::temperature] / averages[mpm::Averages::volume];
      rate = first_step ? (face->value - mapped) / dt : Real(0);
      sum.gain.boundary += dt * (capacity * rate - power);
      return;
    }
    if (face != nullptr && face->kind == FaceHeat::flux) {
      // A full row of cells gives its face node half a cell of volume: area = 2 V / cell.
      const Real inflow = face->value * Real(2) * nodes.averages(at)[mpm::Averages::volume] / grid.cell();
      sum.gain.boundary += dt * inflow;
      power += inflow;
    }
    rate = power / capacity;
  }
};

}  // namespace thawslide::band
