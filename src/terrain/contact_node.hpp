// Formulas of contact of one node with the ground (Eqs. 15-17, 20; Nairn 2013; Nairn et al. 2018), and sums for the
// budgets of energy and momentum. For host and device. Walls: constraints on the node's momentum, with any(), true if a
// constraint may act, and apply(mass, momentum), true if a rigid frame acted.
#pragma once

#include <cmath>

#include "base/linear.hpp"
#include "base/portability.hpp"
#include "base/select.hpp"
#include "mpm/mapping.hpp"
#include "mpm/records.hpp"
#include "mpm/tile.hpp"
#include "mpm/vectors_in_records.hpp"
#include "physics/basal/contact_node.hpp"
#include "physics/contact.hpp"

namespace thawslide::terrain {

// Sums over contact and constraints in one step. Energies [J], forces [N], areas [m2].
template <int Dim>
struct ContactWork {
  double friction_work = 0;                                 // dissipated by sliding
  double loss = 0;                                          // dissipated by impact on ground and walls, and by sticking
  double frame_work = 0;                                    // done by rigid frames on the sliding mass
  double converted = 0;                                     // friction work not converted to heat
  double damping = 0;                                       // dissipated by mass damping
  double node_kinetic = 0;                                  // sum m |a dt|^2 / 2 over nodes
  double area = 0;                                          // in contact
  double friction_area = 0;                                 // sum mu_e A
  double shear_force = 0;                                   // of the ground on the sliding mass, in any direction
  double bed_work = 0;                                      // lost to entrained bed material
  Vector<double, Dim> force = Vector<double, Dim>::Zero();  // on the ground
  // On the sliding mass, from walls, frames and mass damping [N s].
  Vector<double, Dim> constraint_impulse = Vector<double, Dim>::Zero();
  Vector<double, Dim> bed_impulse = Vector<double, Dim>::Zero();  // on entrained bed material [N s]

  THAWSLIDE_HD ContactWork& operator+=(const ContactWork& part) {
    friction_work += part.friction_work;
    loss += part.loss;
    frame_work += part.frame_work;
    converted += part.converted;
    damping += part.damping;
    node_kinetic += part.node_kinetic;
    area += part.area;
    friction_area += part.friction_area;
    shear_force += part.shear_force;
    force += part.force;
    constraint_impulse += part.constraint_impulse;
    bed_work += part.bed_work;
    bed_impulse += part.bed_impulse;
    return *this;
  }
};

// Smallest contact area, as a fraction of a cell's face: keeps N = p.n / (A dt) finite without ground nearby.
inline constexpr double smallest_area = 1e-6;

// State of one node between trial and final momentum.
template <int Dim>
struct NodeState {
  double mass;
  Vector<double, Dim> old_momentum, momentum;
  Vector<double, Dim> constraint_impulse;  // of walls and frames [N s]
  bool in_frame;
};

template <int Dim, class Walls>
THAWSLIDE_HD void constrain(const Walls& walls, NodeState<Dim>& state) {
  if (walls.any()) {
    const Vector<double, Dim> before = state.momentum;
    state.in_frame = walls.apply(state.mass, state.momentum);
    state.constraint_impulse += state.momentum - before;
  }
}

// Trial momentum: old momentum with forces, damping and constraints. record: of MomentumLayout.
template <int Dim, class Walls, class Record>
THAWSLIDE_HD NodeState<Dim> trial_state(const Walls& walls, double dt, double damping, const Record& record) {
  using Layout = mpm::MomentumLayout<Dim>;
  NodeState<Dim> state;
  state.mass = record[Layout::mass];
  state.old_momentum = mpm::vector_at<Dim>(record, Layout::momentum);
  state.momentum =
      state.old_momentum + dt * mpm::vector_at<Dim>(record, Layout::force) - damping * dt * state.old_momentum;
  state.constraint_impulse.setZero();
  state.in_frame = false;
  constrain(walls, state);
  return state;
}

// Covered fraction of the ground at a node of layer 0: the largest filled fraction of the node's space and of the
// spaces of the next two nodes above, because contact acts before the gap below the mass is closed. space: of a node
// above the ground [m3]. volume(step): of the particles at the node `step` layers above [m3].
template <class Volume>
THAWSLIDE_HD double covered_fraction(double space, const Volume& volume) {
  const auto filled = [](double of_particles, double whole) {
    return of_particles < whole ? of_particles / whole : 1.0;
  };
  double fraction = filled(volume(0), 0.5 * space);
  for (int step = 1; step <= 2 && fraction < 1.0; ++step) {
    fraction = max(fraction, filled(volume(step), space));
  }
  return fraction;
}

// Normal pressure [Pa] at a node: load over covered area of the nodes of its column. Nodes below the ground bear load
// of particles that have sunk in. base(step): record of BaseLoad of the node `step` layers above.
template <class Base>
THAWSLIDE_HD double pressure_of_column(double dt, double smallest_area, const Base& base) {
  double load = 0, covered = 0;
  for (int step = -1; step <= 1; ++step) {
    const auto& record = base(step);
    load += record[mpm::BaseLoad::load];
    covered += record[mpm::BaseLoad::covered];
  }
  return load / (dt * max(covered, smallest_area));
}

// Contact node with normal pressure [Pa] and slip speed; all other members are 0.
template <int Dim>
THAWSLIDE_HD physics::basal::ContactNode loaded_node(double pressure, const Vector<double, Dim>& into_ground,
                                                     const NodeState<Dim>& state) {
  physics::basal::ContactNode node{};
  node.normal_pressure = pressure;
  node.speed = (state.momentum - state.momentum.dot(into_ground) * into_ground).norm() / state.mass;
  return node;
}

// Input of the basal laws at a node. known: record of NodalState. volume: sum S V of the linear shape functions.
// near_ground: record of NearGround. pore_pressure: off means P = 0.
template <int Dim, class StateRecord, class NearGroundRecord>
THAWSLIDE_HD physics::basal::ContactNode contact_node_of(const StateRecord& known, double volume,
                                                         const NearGroundRecord& near_ground, double pressure,
                                                         bool pore_pressure, const Vector<double, Dim>& into_ground,
                                                         const NodeState<Dim>& state) {
  using mpm::NearGround, mpm::NodalState;
  // A node can have GIMP mass without linear weight; its averages are then weighted by mass.
  const auto average = [&](double by_linear, std::size_t by_mass) {
    return volume > 0.0 ? by_linear : near_ground[by_mass] / state.mass;
  };
  auto node = loaded_node<Dim>(pressure, into_ground, state);
  node.pore_pressure = pore_pressure ? average(known[NodalState::pore_pressure], NearGround::pore_pressure) : 0.0;
  node.saturation = average(near_ground[NearGround::saturation_by_linear] / volume, NearGround::saturation);
  node.solid_fraction = average(near_ground[NearGround::solid_fraction_by_linear] / volume, NearGround::solid_fraction);
  node.temperature = average(known[NodalState::temperature], NearGround::temperature);
  node.slip = near_ground[NearGround::slip] / state.mass;
  return node;
}

// Replaces the basal state by that of the band columns. Without columns yet, the state is that of the body, with zero
// pore pressure. state: record of BaseState.
template <class Record>
THAWSLIDE_HD void set_columns_state(const Record& state, bool pore_pressure, physics::basal::ContactNode& node) {
  using mpm::BaseState;
  const double area = state[BaseState::area];
  if (!(area > 0.0)) {
    node.pore_pressure = 0.0;
    return;
  }
  node.pore_pressure = pore_pressure ? state[BaseState::pressure_ratio] / area * node.normal_pressure : 0.0;
  node.saturation = state[BaseState::saturation] / area;
  node.solid_fraction = state[BaseState::solid_fraction] / area;
  node.temperature = state[BaseState::temperature] / area;
  node.slip = state[BaseState::slip] / area;
}

}  // namespace thawslide::terrain
