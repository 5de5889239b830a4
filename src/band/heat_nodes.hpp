// The nodes' part of conduct_heat: their state, and their rate of temperature.
#pragma once

#include <algorithm>
#include <iterator>
#include <utility>

#include "band/heat.hpp"

namespace thawslide::band {

template <int Dim, class Real>
bool any_face_condition(const BandModel<Dim, Real>& model) {
  return std::any_of(std::begin(model.faces), std::end(model.faces),
                     [](const HeatFace<Real>& face) { return face.kind != FaceHeat::insulated; });
}

// The face of the domain a node lies on, if that face has a condition for heat; null otherwise.
template <int Dim, class Real>
const HeatFace<Real>* face_of(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model, std::size_t b,
                              std::size_t k) {
  const Vector<Real, Dim> position = mpm::node_position(grid, b, k);
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

// Temperature and pore pressure of the nodes of a block; a prescribed temperature takes its node before gradients are
// formed.
template <int Dim, class Real>
void set_node_state(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                    const mpm::Nodes<Dim, Real>& nodes, std::size_t b, HeatNodes<Dim, Real>& work) {
  const bool has_faces = any_face_condition(model);
  for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<Dim>::nodes); ++k) {
    const auto& linear = nodes.linear(b, k);
    auto& state = work.state(b, k);
    state.fill(Real(0));
    if (linear[mpm::LinearLayout::volume] > Real(0)) {
      const Real inverse_volume = Real(1) / linear[mpm::LinearLayout::volume];
      state[0] = linear[mpm::LinearLayout::temperature] * inverse_volume;
      state[1] = linear[mpm::LinearLayout::pore_pressure] * inverse_volume;
      const HeatFace<Real>* face = has_faces ? face_of(grid, model, b, k) : nullptr;
      if (face != nullptr && face->kind == FaceHeat::temperature) {
        state[0] = face->value;
      }
    }
  }
}

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

// The nodal rate of temperature with what `stored_at` gives: the capacity, and the heat that particles took by subgrid
// diffusion; friction heat and face conditions come in here. sum_block(b) comes first and makes the sums of a block
// that stored_at reads.
template <int Dim, class Real, class SumBlock, class StoredAt>
HeatGain<Real> solve_rates(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model, Real dt,
                           bool first_step, const mpm::Nodes<Dim, Real>& nodes, const SumBlock& sum_block,
                           const StoredAt& stored_at, HeatNodes<Dim, Real>& work) {
  work.orphan.resize(grid.blocks().size());
  const bool has_faces = any_face_condition(model);
  const Real inverse_dt = Real(1) / dt;
  const auto solved = parallel_sum<NodalHeat<Real>>(grid.blocks().size(), [&](std::size_t b, NodalHeat<Real>& sum) {
    sum_block(b);
    HeatGain<Real>& gain = sum.gain;
    for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<Dim>::nodes); ++k) {
      const auto& rates = work.rates(b, k);
      const Real friction = nodes.contact(b, k)[mpm::ContactLayout::friction_heat];
      const auto [capacity, subgrid_heat] = stored_at(b, k);
      Real& rate = work.state(b, k)[2];
      rate = Real(0);
      work.orphan(b, k)[0] = Real(0);
      gain.friction += dt * friction;
      if (!(capacity > Real(0))) {
        if (friction > Real(0)) {
          work.orphan(b, k)[0] = friction / nodes.momentum(b, k)[mpm::MomentumLayout<Dim>::mass];
          sum.any_orphan = true;
        }
        continue;
      }
      Real power = rates[0] + rates[1] + friction - subgrid_heat * inverse_dt;
      gain.advection += dt * rates[1];
      const HeatFace<Real>* face = has_faces ? face_of(grid, model, b, k) : nullptr;
      if (face != nullptr && face->kind == FaceHeat::temperature) {
        const auto& linear = nodes.linear(b, k);
        const Real mapped = linear[mpm::LinearLayout::temperature] / linear[mpm::LinearLayout::volume];
        rate = first_step ? (face->value - mapped) / dt : Real(0);
        gain.boundary += dt * (capacity * rate - power);
        continue;
      }
      if (face != nullptr && face->kind == FaceHeat::flux) {
        // A full row of cells gives its face node half a cell of volume: area = 2 V / cell.
        const Real inflow = face->value * Real(2) * nodes.linear(b, k)[mpm::LinearLayout::volume] / grid.cell();
        gain.boundary += dt * inflow;
        power += inflow;
      }
      rate = power / capacity;
    }
  });
  work.any_orphan = solved.any_orphan;
  return solved.gain;
}

}  // namespace thawslide::band
