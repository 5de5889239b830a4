// Contact with the ground at the nodes of a step, as kernels of one node: kernel(step, node, candidate). `candidate` is
// the node's number among the candidate nodes of the step, those on the ground or below it; absent for others. The
// trial momentum is corrected once: correcting both the old momentum and the force, as Eq. 15 reads, would count
// contact twice. For host and device.
#pragma once

#include <limits>

#include "exec/key_lists.hpp"
#include "mpm/base_states.hpp"
#include "mpm/section_width.hpp"
#include "mpm/tile_tables.hpp"
#include "terrain/basal_law.hpp"
#include "terrain/bed_node.hpp"
#include "terrain/column_heights.hpp"
#include "terrain/contact_node.hpp"

namespace thawslide::terrain {

using exec::absent;

// Options of contact at a node.
struct ContactOptions {
  bool base_is_fixed = false;   // no slip, during gravity settling
  bool pore_pressure = true;    // off: P = 0 at contact nodes (mechanism P of Sec. 3.3)
  bool distance_check = false;  // contact acts only after a node has closed its clearance
  double mass_damping = 0;      // [1/s]
};

// Nodes of a step. Nodes: access to their records (mpm/nodes.hpp, device/node_access.hpp). ground(node): GroundAtNode;
// walls(node): mpm::NodeConstraints.
template <class Nodes, class Ground, class Walls, int Dim>
struct NodesInStep {
  static constexpr int dim = Dim;

  Nodes nodes;
  Ground ground;
  Walls walls;
  mpm::BlockTables<Dim> blocks;
  mpm::WidthView width;
  ContactOptions options;
  double cell, time, dt;

  // Of a node above the ground [m3].
  template <class Node>
  [[nodiscard]] THAWSLIDE_HD double space(const Node& node) const {
    return (Dim == 2 ? width.at(nodes.position(node)[0]) : cell) * cell * cell;
  }
  // Finds the node `step` layers above; false if there is no such block.
  template <class Node>
  THAWSLIDE_HD bool find_above(const Node& node, int step, Node& found) const {
    constexpr auto stencil = static_cast<std::size_t>(mpm::Tile<Dim>::stencil);
    const auto adjacent = mpm::Tile<Dim>::adjacent(static_cast<int>(nodes.in_block(node)), Dim - 1, step);
    const std::int32_t block =
        blocks.blocks_about_block[nodes.block(node) * stencil + static_cast<std::size_t>(adjacent.direction)];
    found = nodes.node(static_cast<std::size_t>(block), static_cast<std::size_t>(adjacent.local));
    return block != absent;
  }
};

template <class Step, class Node>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE bool has_mass(const Step& step, const Node& node) {
  return step.nodes.template read<mpm::Momentum>(node)[mpm::MomentumLayout<Step::dim>::mass] > 0.0;
}
template <class Step, class Node>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE NodeState<Step::dim> trial_of(const Step& step, const Node& node) {
  return trial_state<Step::dim>(step.walls(node), step.dt, step.options.mass_damping,
                                step.nodes.template read<mpm::Momentum>(node));
}
// Momentum of a node into the ground in this step, minus the part that closes its clearance, which its record has along
// the vertical.
template <class Step, class Node>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE double approach(const Step& step, const Node& node, double mass,
                                                     const Vector<double, Step::dim>& momentum) {
  const auto& normal = step.ground(node).normal;
  const double inward = momentum.dot(normal);
  const double vertical = step.nodes.template read<mpm::NearGround>(node)[mpm::NearGround::clearance];
  const double left = max(0.0, -normal[Step::dim - 1] * vertical);  // [m]
  return max(0.0, step.options.distance_check ? inward - mass * (left / step.dt) : inward);
}

// Load on the ground [kg m/s] and covered area [m2] of a candidate node.
struct PressOnGround {
  template <class Step, class Node>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(const Step& step, const Node& node,
                                                       std::size_t /*candidate*/) const {
    const auto& ground = step.ground(node);
    double* base = step.nodes.template write<mpm::BaseLoad>(node);
    base[mpm::BaseLoad::load] = 0.0;
    if (has_mass(step, node)) {
      const auto state = trial_of(step, node);
      base[mpm::BaseLoad::load] = ground.bend * approach(step, node, state.mass, state.momentum);
    }
    base[mpm::BaseLoad::covered] = 0.0;
    if (ground.area > 0.0) {
      const auto volume = [&](int above) {
        Node other = node;
        return step.find_above(node, above, other)
                   ? step.nodes.template read<mpm::Momentum>(other)[mpm::MomentumLayout<Step::dim>::volume]
                   : 0.0;
      };
      base[mpm::BaseLoad::covered] = ground.area * covered_fraction(step.space(node), volume);
    }
  }
};

// True if a candidate node is loaded where no band column is in reach.
template <int Dim>
struct LoadsBareGround {
  mpm::BaseStates<Dim> columns;

  template <class Step, class Node>
  [[nodiscard]] bool operator()(const Step& step, const Node& node, std::size_t /*candidate*/) const {
    return step.nodes.template read<mpm::BaseLoad>(node)[mpm::BaseLoad::load] > 0.0 &&
           !(columns.at(step.nodes.block(node), step.nodes.in_block(node))[mpm::BaseState::area] > 0.0);
  }
};

// Input of the basal laws at a candidate node; its area is 0 unless it is loaded. The basal area is divided among nodes
// in proportion to their loads.
template <int Dim>
struct GatherBasalNode {
  double smallest_area, gravity;  // [m2], [m/s2]
  bool reads_mass;                // off: no law depends on the state of the sliding mass
  mpm::BaseStates<Dim> columns;   // of band columns
  BasalNode* bases;

  template <class Step, class Node>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(const Step& step, const Node& node,
                                                       std::size_t candidate) const {
    using mpm::BaseLoad;
    using Layout = mpm::MomentumLayout<Dim>;
    BasalNode& base = bases[candidate];
    const double load = step.nodes.template read<BaseLoad>(node)[BaseLoad::load];
    base.area = 0.0;
    if (!(load > 0.0)) {
      return;
    }
    const double none[BaseLoad::size<Dim>] = {};
    const double pressure = pressure_of_column(step.dt, smallest_area, [&](int above) -> const double* {
      Node other = node;
      return step.find_above(node, above, other) ? step.nodes.template read<BaseLoad>(other) : none;
    });
    base.area = load / (pressure * step.dt);
    base.substrate = step.ground(node).substrate;
    const auto& normal = step.ground(node).normal;
    const double* column = columns.at(step.nodes.block(node), step.nodes.in_block(node));
    const bool on_column = column != nullptr && column[mpm::BaseState::area] > 0.0;
    base.state = on_column || !reads_mass
                     ? loaded_node<Dim>(pressure, normal, trial_of(step, node))
                     : contact_node_of<Dim>(step.nodes.template read<mpm::NodalState>(node),
                                            step.nodes.template read<mpm::Averages>(node)[mpm::Averages::volume],
                                            step.nodes.template read<mpm::NearGround>(node), pressure,
                                            step.options.pore_pressure, normal, trial_of(step, node));
    if (column != nullptr) {
      set_columns_state(column, step.options.pore_pressure, base.state);
    }
    base.state.time = step.time;
    const double* momentum = step.nodes.template read<mpm::Momentum>(node);
    base.state.unit_weight = gravity * momentum[Layout::mass] / momentum[Layout::volume];
  }
};

// Points on the ground below candidate nodes [m, relative to the domain's lower corner].
template <int Dim>
struct LocateOnGround {
  double* positions;

  template <class Step, class Node>
  THAWSLIDE_HD void operator()(const Step& step, const Node& node, std::size_t candidate) const {
    Vector<double, Dim> position = step.nodes.position(node);
    position[Dim - 1] = step.ground(node).elevation;
    mpm::set_vector<Dim>(positions, candidate * Dim, position);
  }
};

// Applies contact to a loaded node: changes its momentum from trial to final, fills its record of Contact, and adds its
// work. strength: of the base [Pa]. In a bend of the ground, the normal pressures on its parts partly cancel: their
// resultant, the normal impulse, is smaller by `bend` than the load on the ground. Friction, cohesion and entrainment
// use the load (GroundAtNode::bend; a V-shaped channel of half angle a has 1/sin(a)). The paper has one contact normal
// per node and flat ground.
template <class Step, class Node, int Dim>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void touch_ground(const Step& step, const Node& node, const BasalNode& base,
                                                       double strength, double heat_fraction,
                                                       const BedBelowNodes<Dim>& bed, std::size_t candidate,
                                                       NodeState<Dim>& state, ContactWork<Dim>& work) {
  using mpm::Contact;
  const auto& ground = step.ground(node);
  const Vector<double, Dim>& normal = ground.normal;
  const double dt = step.dt, load = step.nodes.template read<mpm::BaseLoad>(node)[mpm::BaseLoad::load];
  const Vector<double, Dim> tangential = state.momentum - state.momentum.dot(normal) * normal;
  const double tangential_size = tangential.norm();
  auto impulse = physics::contact_impulse(load / ground.bend, tangential_size, base.area, dt, strength);
  Vector<double, Dim> along = Vector<double, Dim>::Zero();
  if (tangential_size > 0.0) {
    along = tangential / tangential_size;
  }
  const EntrainmentImpulse entrain = bed.entrain(candidate, impulse, load / (base.area * dt), base.area, strength, dt,
                                                 state.mass, along, tangential_size);
  impulse.tangential -= entrain.of_friction;
  const Vector<double, Dim> total = -impulse.normal * normal - impulse.tangential * along;
  const Vector<double, Dim> to_bed = entrain.impulse * along;
  state.momentum += total - to_bed;
  constrain(step.walls(node), state);  // walls and frames take precedence over the ground
  const Vector<double, Dim> middle = (state.old_momentum + state.momentum) / (2.0 * state.mass);
  const double slip_speed = max(0.0, middle.dot(along));
  const double friction_work = impulse.slides ? impulse.tangential * slip_speed : 0.0;
  if (entrain.entrained > 0.0) {
    bed.record(candidate, to_bed.dot(middle), load / dt / base.area);
    work.bed_work += to_bed.dot(middle);
    work.bed_impulse += to_bed;
  }
  work.friction_work += friction_work;
  work.converted += (1.0 - heat_fraction) * friction_work;
  work.loss += -total.dot(middle) - friction_work;
  work.force -= total / dt;
  work.area += base.area;
  work.friction_area += base.friction * base.area;
  work.shear_force += impulse.tangential / dt;
  double* contact = step.nodes.template write<Contact>(node);
  contact[Contact::touching] = 1.0;
  contact[Contact::slip_speed] = impulse.slides ? slip_speed : 0.0;
  contact[Contact::friction_heat] = heat_fraction * friction_work / dt;
  contact[Contact::normal_force] = load / dt;
  contact[Contact::area] = base.area;
}

// Stores the motion of a node with its final momentum, and sums the energy dissipated by constraints, damping and FLIP.
// The force on a node of a held body counts as one of the ground, which holds it.
template <class Step, class Node, int Dim>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void store_motion(const Step& step, const Node& node, const NodeState<Dim>& state,
                                                       ContactWork<Dim>& work) {
  using mpm::MotionLayout;
  const auto walls = step.walls(node);
  const double damping = step.options.mass_damping, dt = step.dt;
  const double inverse_mass = 1.0 / state.mass, inverse_dt = 1.0 / dt;
  const Vector<double, Dim> change = state.momentum - state.old_momentum;
  const Vector<double, Dim> middle = 0.5 * inverse_mass * (state.old_momentum + state.momentum);
  double* motion = step.nodes.template write<mpm::Motion>(node);
  mpm::set_vector<Dim>(motion, MotionLayout<Dim>::acceleration, change * (inverse_mass * inverse_dt));
  mpm::set_vector<Dim>(motion, MotionLayout<Dim>::middle_velocity, middle);
  work.node_kinetic += 0.5 * change.squaredNorm() * inverse_mass;
  if (damping > 0.0) {
    work.constraint_impulse -= damping * dt * state.old_momentum;
    work.damping += damping * dt * state.old_momentum.dot(middle);
  }
  if (walls.any()) {
    const double constraint_work = state.constraint_impulse.dot(middle);
    work.constraint_impulse += state.constraint_impulse;
    work.frame_work += state.in_frame ? constraint_work : 0.0;
    work.loss -= state.in_frame ? 0.0 : constraint_work;
  }
  if (walls.is_held()) {
    work.constraint_impulse -= state.constraint_impulse;
    work.force -= state.constraint_impulse / dt;
  }
}

// From nodal momentum and force to nodal motion.
template <int Dim>
struct ResolveContact {
  using Sum = ContactWork<Dim>;

  const BasalNode* bases;   // by candidate
  const double* strengths;  // by candidate [Pa], in place of those of the laws; null: none
  physics::FrictionClamp clamp;
  bool cap_pressure;
  double heat_fraction;
  BedBelowNodes<Dim> bed;

  [[nodiscard]] THAWSLIDE_HD bool touches(std::int32_t candidate) const {
    return candidate != absent && bases[candidate].area > 0.0;
  }
  template <class Step, class Node>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(const Step& step, const Node& node, std::int32_t candidate,
                                                       Sum& contact, Sum& motion) const {
    clear<mpm::Motion>(step.nodes.template write<mpm::Motion>(node));
    if (double* record = step.nodes.template write<mpm::Contact>(node); record != nullptr) {
      clear<mpm::Contact>(record);
      record[mpm::Contact::candidate] = candidate != absent ? 1.0 : 0.0;
    }
    if (!has_mass(step, node)) {
      return;
    }
    auto state = trial_of(step, node);
    if (touches(candidate)) {
      const auto number = static_cast<std::size_t>(candidate);
      const double strength = step.options.base_is_fixed ? std::numeric_limits<double>::infinity()
                              : strengths != nullptr     ? strengths[number]
                                                         : bases[number].strength(clamp, cap_pressure);
      touch_ground(step, node, bases[number], strength, heat_fraction, bed, number, state, contact);
    }
    store_motion(step, node, state, motion);
  }

 private:
  template <class Name>
  THAWSLIDE_HD static void clear(double* record) {
    for (std::size_t c = 0; c < mpm::record_size(mpm::components_of<Name, Dim>); ++c) {
      record[c] = 0.0;
    }
  }
};

// Velocity of a node from the momentum that particles map back (MUSL), with the same conditions as in the step: at
// contact nodes, the inward normal component is removed except for the part that closes the clearance (no friction, no
// heat). Adds the work of internal forces [J] at the mid-step velocity minus that at the mapped-back velocity.
template <int Dim>
struct MapBack {
  using Sum = double;

  Vector<double, Dim> gravity;  // [m/s2]

  [[nodiscard]] THAWSLIDE_HD static bool touches(std::int32_t /*candidate*/) { return false; }
  template <class Step, class Node>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(const Step& step, const Node& node, std::int32_t candidate,
                                                       double& /*contact*/, double& work) const {
    using Layout = mpm::MomentumLayout<Dim>;
    if (!has_mass(step, node)) {
      return;
    }
    const double* record = step.nodes.template read<mpm::Momentum>(node);
    double* mapped = step.nodes.template write<mpm::Velocity>(node);
    const double mass = record[Layout::mass];
    Vector<double, Dim> momentum = mpm::vector_at<Dim>(mapped, 0);
    if (candidate != absent && step.nodes.template read<mpm::Contact>(node)[mpm::Contact::touching] > 0.0) {
      momentum -= approach(step, node, mass, momentum) * step.ground(node).normal;
    }
    step.walls(node).apply(mass, momentum);
    const Vector<double, Dim> velocity = momentum * (1.0 / mass);
    mpm::set_vector<Dim>(mapped, 0, velocity);
    const Vector<double, Dim> internal_force = mpm::vector_at<Dim>(record, Layout::force) - mass * gravity;
    const auto middle =
        mpm::vector_at<Dim>(step.nodes.template read<mpm::Motion>(node), mpm::MotionLayout<Dim>::middle_velocity);
    work += step.dt * internal_force.dot(middle - velocity);
  }
};

}  // namespace thawslide::terrain
