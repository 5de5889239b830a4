// Thermal boundary conditions at the faces of the domain. For host and device.
#pragma once

#include "base/linear.hpp"
#include "base/portability.hpp"
#include "mpm/records.hpp"
#include "physics/options.hpp"

namespace thawslide::band {

using physics::HeatBoundaryKind;

struct HeatFace {
  HeatBoundaryKind kind = HeatBoundaryKind::insulated;
  double value = 0;  // [C], or [W/m2] into the body
};

template <int Dim>
struct HeatFaces {
  HeatFace faces[2 * Dim] = {};
  Vector<double, Dim> extent;  // upper corner of the domain [m]

  [[nodiscard]] THAWSLIDE_HD bool any() const {
    for (const HeatFace& face : faces) {
      if (face.kind != HeatBoundaryKind::insulated) {
        return true;
      }
    }
    return false;
  }

  // Face with a condition that contains a node at a position; null if there is none.
  [[nodiscard]] THAWSLIDE_HD const HeatFace* at(const Vector<double, Dim>& position) const {
    for (int a = 0; a < Dim; ++a) {
      const HeatFace& lower = faces[2 * a];
      const HeatFace& upper = faces[2 * a + 1];
      if (lower.kind != HeatBoundaryKind::insulated && position[a] <= round_off * extent[a]) {
        return &lower;
      }
      if (upper.kind != HeatBoundaryKind::insulated && position[a] >= extent[a] * (1.0 - round_off)) {
        return &upper;
      }
    }
    return nullptr;
  }
};

// Sets a prescribed nodal temperature before gradients are computed. face: of the node, or null. state: record of
// NodalState.
template <class Record>
THAWSLIDE_HD void prescribe_temperature(const HeatFace* face, Record& state) {
  if (face != nullptr && face->kind == HeatBoundaryKind::temperature) {
    state[mpm::NodalState::temperature] = face->value;
  }
}

// Applies the condition of a node's face, if any. Returns true if it prescribes the temperature rate; an inflow adds to
// the power [W]. averages: record of Averages. first_step: prescribed temperatures are applied as a jump. inflow: heat
// gained [J].
template <class Record>
THAWSLIDE_HD bool meets_face(const HeatFace* face, bool first_step, const Record& averages, double capacity,
                             double cell, double dt, double& rate, double& power, double& inflow) {
  using mpm::Averages;
  if (face != nullptr && face->kind == HeatBoundaryKind::temperature) {
    const double mapped = averages[Averages::temperature] / averages[Averages::volume];
    rate = first_step ? (face->value - mapped) / dt : 0.0;
    inflow += dt * (capacity * rate - power);
    return true;
  }
  if (face != nullptr && face->kind == HeatBoundaryKind::flux) {
    // A full row of cells gives its face node half a cell of volume: area = 2 V / cell.
    const double through_face = face->value * 2.0 * averages[Averages::volume] / cell;
    inflow += dt * through_face;
    power += through_face;
  }
  return false;
}

}  // namespace thawslide::band
