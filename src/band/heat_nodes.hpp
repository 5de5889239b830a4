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
    const bool held = nodes.orphan_heat.holds(at.block);
    Real none = 0;
    Real& orphan = held ? nodes.orphan_heat.of_block(at.block)[at.node][0] : none;
    solve_temperature_rate<Dim>(
        nodes.heat_rates(at), capacity, subgrid, nodes.contact(at)[mpm::Contact::friction_heat], nodes.momentum(at), dt,
        nodes.state(at)[mpm::NodalState::temperature_rate], orphan, sum,
        [&](Real& rate, Real& power) { return meets_face(nodes, at, capacity, rate, power, sum); });
    THAWSLIDE_ASSERT(held || !(orphan > Real(0)), "friction heat at node {} of block {}, which is in no contact",
                     at.node, at.block);
  }

 private:
  // The condition of the face that a node lies on, if any: whether it prescribes the rate; else heat that flows in adds
  // to the power.
  bool meets_face(const mpm::Nodes<Dim, Real>& nodes, const mpm::NodeAt& at, Real capacity, Real& rate, Real& power,
                  NodalHeat<Real>& sum) const {
    const HeatFace<Real>* face = has_faces ? face_of(grid, model, at) : nullptr;
    if (face != nullptr && face->kind == FaceHeat::temperature) {
      const auto& averages = nodes.averages(at);
      const Real mapped = averages[mpm::Averages::temperature] / averages[mpm::Averages::volume];
      rate = first_step ? (face->value - mapped) / dt : Real(0);
      sum.gain.boundary += dt * (capacity * rate - power);
      return true;
    }
    if (face != nullptr && face->kind == FaceHeat::flux) {
      // A full row of cells gives its face node half a cell of volume: area = 2 V / cell.
      const Real inflow = face->value * Real(2) * nodes.averages(at)[mpm::Averages::volume] / grid.cell();
      sum.gain.boundary += dt * inflow;
      power += inflow;
    }
    return false;
  }
};

}  // namespace thawslide::band
