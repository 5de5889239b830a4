// Contact of one node with the ground (Eqs. 15-17, 20; Nairn 2013; Nairn et al. 2018), from trial momentum to motion.
// For host and device. Walls: constraints on the node's momentum, with any(), true if a constraint may act, and
// apply(mass, momentum), true if a rigid frame acted.
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
#include "terrain/contact_work.hpp"

namespace thawslide::terrain {

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

// Momentum of a node into the ground in this step, minus the part that closes the clearance [m].
inline THAWSLIDE_HD double approach(bool distance_check, double clearance, double dt, double mass,
                                    double inward_momentum) {
  const double left = max(0.0, clearance);
  return max(0.0, distance_check ? inward_momentum - mass * (left / dt) : inward_momentum);
}

// Clearance along the normal [m] from that of a record, which is along the vertical.
template <int Dim>
THAWSLIDE_HD double clearance_along_normal(const Vector<double, Dim>& normal, double clearance) {
  return -normal[Dim - 1] * clearance;
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

// Unit weight rho g [N/m3] of the sliding mass at a node. record: of MomentumLayout.
template <int Dim, class Record>
THAWSLIDE_HD double unit_weight_of(const Record& record, double gravity) {
  using Layout = mpm::MomentumLayout<Dim>;
  return gravity * record[Layout::mass] / record[Layout::volume];
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

// Transfer from a contact node to the bed material in a step.
struct EntrainmentImpulse {
  double entrained = 0;    // [kg]
  double impulse = 0;      // along the slip [N s]
  double of_friction = 0;  // part of it already removed by friction [N s]
};

// Used when there is no bed.
struct NoBed {
  template <int Dim>
  THAWSLIDE_HD EntrainmentImpulse entrain(const physics::ContactImpulse& /*impulse*/, double /*normal_pressure*/,
                                          const Vector<double, Dim>& /*along*/, double /*tangential_size*/) const {
    return {};
  }
  THAWSLIDE_HD void record(double /*work*/, double /*normal_pressure*/) const {}
};

// Ground and strength at a contact node. In a bend of the ground, the normal pressures on its parts partly cancel:
// their resultant, the normal impulse, is smaller by `bend` than the load on the ground. Friction, cohesion and
// entrainment use the load (GroundAtNode::bend; a V-shaped channel of half angle a has 1/sin(a)). The paper has one
// contact normal per node and flat ground.
template <int Dim>
struct ContactConditions {
  const Vector<double, Dim>& normal;  // into the ground
  double load;                        // normal impulse times bend [kg m/s]
  double bend;
  double area, strength, friction;  // [m2], of the base [Pa], coefficient
};

// Applies the contact impulse of one node and adds its work. Updates state.momentum from trial to final. left: record
// of Contact.
template <int Dim, class Walls, class FromBed, class Record>
THAWSLIDE_HD void apply_contact(const Walls& walls, const ContactConditions<Dim>& conditions, double heat_fraction,
                                double dt, const FromBed& bed, NodeState<Dim>& state, ContactWork<Dim>& work,
                                Record& left) {
  using mpm::Contact;
  const Vector<double, Dim>& normal = conditions.normal;
  const Vector<double, Dim> tangential = state.momentum - state.momentum.dot(normal) * normal;
  const double tangential_size = tangential.norm();
  auto impulse = physics::contact_impulse(conditions.load / conditions.bend, tangential_size, conditions.area, dt,
                                          conditions.strength);
  Vector<double, Dim> along = Vector<double, Dim>::Zero();
  if (tangential_size > 0.0) {
    along = tangential / tangential_size;
  }
  const EntrainmentImpulse entrain =
      bed.template entrain<Dim>(impulse, conditions.load / (conditions.area * dt), along, tangential_size);
  impulse.tangential -= entrain.of_friction;
  const Vector<double, Dim> total = -impulse.normal * normal - impulse.tangential * along;
  const Vector<double, Dim> to_bed = entrain.impulse * along;
  state.momentum += total - to_bed;
  constrain(walls, state);  // walls and frames take precedence over the ground
  const Vector<double, Dim> middle = (state.old_momentum + state.momentum) / (2.0 * state.mass);
  const double slip_speed = max(0.0, middle.dot(along));
  const double friction_work = impulse.slides ? impulse.tangential * slip_speed : 0.0;
  if (entrain.entrained > 0.0) {
    bed.record(to_bed.dot(middle), conditions.load / dt / conditions.area);
    work.bed_work += to_bed.dot(middle);
    work.bed_impulse += to_bed;
  }
  work.friction_work += friction_work;
  work.converted += (1.0 - heat_fraction) * friction_work;
  work.loss += -total.dot(middle) - friction_work;
  work.force -= total / dt;
  work.area += conditions.area;
  work.friction_area += conditions.friction * conditions.area;
  work.shear_force += impulse.tangential / dt;
  left[Contact::touching] = 1.0;
  left[Contact::slip_speed] = impulse.slides ? slip_speed : 0.0;
  left[Contact::friction_heat] = heat_fraction * friction_work / dt;
  left[Contact::normal_force] = conditions.load / dt;
  left[Contact::area] = conditions.area;
}

// Stores the motion of a node, and sums the energy dissipated by constraints, damping and FLIP. constrained: walls or
// frames may have acted. motion: record of MotionLayout.
template <int Dim, class Record>
THAWSLIDE_HD void finish_node(const NodeState<Dim>& state, bool constrained, double damping, double dt,
                              ContactWork<Dim>& work, Record& motion) {
  using mpm::MotionLayout;
  const double inverse_mass = 1.0 / state.mass, inverse_dt = 1.0 / dt;
  const Vector<double, Dim> change = state.momentum - state.old_momentum;
  const Vector<double, Dim> middle = 0.5 * inverse_mass * (state.old_momentum + state.momentum);
  mpm::set_vector<Dim>(motion, MotionLayout<Dim>::acceleration, change * (inverse_mass * inverse_dt));
  mpm::set_vector<Dim>(motion, MotionLayout<Dim>::middle_velocity, middle);
  work.node_kinetic += 0.5 * change.squaredNorm() * inverse_mass;
  if (damping > 0.0) {
    work.constraint_impulse -= damping * dt * state.old_momentum;
    work.damping += damping * dt * state.old_momentum.dot(middle);
  }
  if (constrained) {
    const double constraint_work = state.constraint_impulse.dot(middle);
    work.constraint_impulse += state.constraint_impulse;
    work.frame_work += state.in_frame ? constraint_work : 0.0;
    work.loss -= state.in_frame ? 0.0 : constraint_work;
  }
}

// Ground below a node whose velocity is mapped back; only used if touching.
template <int Dim>
struct GroundOfMappedBack {
  bool touching, distance_check;
  const Vector<double, Dim>* normal;
  double clearance;
};

// Velocity of a node from the momentum that particles map back (MUSL), in its record of Velocity, with the same
// conditions as in the step. Returns the work of internal forces [J] at the mid-step velocity minus that at the
// mapped-back velocity.
template <int Dim, class Walls, class MomentumRecord, class MotionRecord, class VelocityRecord>
THAWSLIDE_HD double map_back(const Walls& walls, const GroundOfMappedBack<Dim>& ground,
                             const Vector<double, Dim>& gravity, double dt, const MomentumRecord& record,
                             const MotionRecord& motion, VelocityRecord& mapped) {
  using Layout = mpm::MomentumLayout<Dim>;
  const double mass = record[Layout::mass];
  Vector<double, Dim> momentum = mpm::vector_at<Dim>(mapped, 0);
  if (ground.touching) {
    const Vector<double, Dim>& normal = *ground.normal;
    momentum -= approach(ground.distance_check, ground.clearance, dt, mass, momentum.dot(normal)) * normal;
  }
  walls.apply(mass, momentum);
  const Vector<double, Dim> velocity = momentum * (1.0 / mass);
  mpm::set_vector<Dim>(mapped, 0, velocity);
  const Vector<double, Dim> internal_force = mpm::vector_at<Dim>(record, Layout::force) - mass * gravity;
  const auto middle = mpm::vector_at<Dim>(motion, mpm::MotionLayout<Dim>::middle_velocity);
  return dt * internal_force.dot(middle - velocity);
}

}  // namespace thawslide::terrain
