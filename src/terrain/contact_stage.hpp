// Contact at one node of a step: load, input of the basal laws, resolution, and velocity mapped back. For host and
// device. Step: nodes, their walls and ground, and parameters of a step (terrain/block_step.hpp,
// device/node_kernels.hpp). It provides space(node), of a node above the ground [m3], and find_above(node, step,
// found), the node `step` layers above, or false if there is no such block.
#pragma once

#include "terrain/basal_law.hpp"
#include "terrain/contact_node.hpp"
#include "terrain/ground_at_node.hpp"

namespace thawslide::terrain {

// Options of contact at a node.
struct ContactOptions {
  bool base_is_fixed = false;   // no slip, during gravity settling
  bool pore_pressure = true;    // off: P = 0 at contact nodes (mechanism P of Sec. 3.3)
  bool distance_check = false;  // contact acts only after a node has closed its clearance
  double mass_damping = 0;      // [1/s]
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
// Clearance of a candidate node along the normal of the ground [m].
template <class Step, class Node>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE double clearance_of(const Step& step, const Node& node) {
  return clearance_along_normal(step.ground(node).normal,
                                step.nodes.template read<mpm::NearGround>(node)[mpm::NearGround::clearance]);
}

// Load of a candidate node on the ground [kg m/s].
template <class Step, class Node>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE double load_on_ground(const Step& step, const Node& node) {
  if (!has_mass(step, node)) {
    return 0.0;
  }
  const auto& ground = step.ground(node);
  const auto state = trial_of(step, node);
  return ground.bend * approach(step.options.distance_check, clearance_of(step, node), step.dt, state.mass,
                                state.momentum.dot(ground.normal));
}

// Ground area that the sliding mass covers at a node [m2].
template <class Step, class Node>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE double covered_ground(const Step& step, const Node& node) {
  const double area = step.ground(node).area;
  return !(area > 0.0)
             ? 0.0
             : area * covered_fraction(step.space(node), [&](int above) {
                 Node other = node;
                 return step.find_above(node, above, other)
                            ? step.nodes.template read<mpm::Momentum>(other)[mpm::MomentumLayout<Step::dim>::volume]
                            : 0.0;
               });
}

// Gathers the input of the basal laws at a node; its area is 0 unless it is loaded. smallest_area [m2]. gravity [m/s2].
// reads_mass: off: no law depends on the state of the sliding mass. columns: record of BaseState; null without band
// columns.
template <class Step, class Node>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void gather_basal_node(const Step& step, const Node& node, double smallest_area,
                                                            double gravity, bool reads_mass, const double* columns,
                                                            BasalNode& base) {
  using mpm::BaseLoad;
  constexpr int Dim = Step::dim;
  base.area = 0.0;
  if (!has_mass(step, node) || !(step.nodes.template read<mpm::BaseLoad>(node)[BaseLoad::load] > 0.0)) {
    return;
  }
  const double none[BaseLoad::size<Dim>] = {};
  const double pressure = pressure_of_column(step.dt, smallest_area, [&](int above) -> const double* {
    Node other = node;
    return step.find_above(node, above, other) ? step.nodes.template read<mpm::BaseLoad>(other) : none;
  });
  // the basal area is divided among nodes in proportion to their loads
  base.area = step.nodes.template read<mpm::BaseLoad>(node)[BaseLoad::load] / (pressure * step.dt);
  base.substrate = step.ground(node).substrate;
  const auto& normal = step.ground(node).normal;
  const bool on_columns = columns != nullptr && columns[mpm::BaseState::area] > 0.0;
  base.state = on_columns || !reads_mass
                   ? loaded_node<Dim>(pressure, normal, trial_of(step, node))
                   : contact_node_of<Dim>(step.nodes.template read<mpm::NodalState>(node),
                                          step.nodes.template read<mpm::Averages>(node)[mpm::Averages::volume],
                                          step.nodes.template read<mpm::NearGround>(node), pressure,
                                          step.options.pore_pressure, normal, trial_of(step, node));
  if (columns != nullptr) {
    set_columns_state(columns, step.options.pore_pressure, base.state);
  }
  base.state.time = step.time;
  base.state.unit_weight = unit_weight_of<Dim>(step.nodes.template read<mpm::Momentum>(node), gravity);
}

// Applies contact to a loaded node. strength: of the base [Pa].
template <class Step, class Node, class FromBed>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void touch_ground(const Step& step, const Node& node, const BasalNode& base,
                                                       double strength, double heat_fraction, const FromBed& bed,
                                                       NodeState<Step::dim>& state, ContactWork<Step::dim>& work) {
  const auto& ground = step.ground(node);
  const ContactConditions<Step::dim> conditions{
      ground.normal, step.nodes.template read<mpm::BaseLoad>(node)[mpm::BaseLoad::load],
      ground.bend,   base.area,
      strength,      base.friction};
  auto* contact = step.nodes.template write<mpm::Contact>(node);
  apply_contact(step.walls(node), conditions, heat_fraction, step.dt, bed, state, work, contact);
}

// Stores the motion of a node with its final momentum. The force on a node of a held body counts as one of the ground,
// which holds it.
template <class Step, class Node>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void store_motion(const Step& step, const Node& node,
                                                       const NodeState<Step::dim>& state,
                                                       ContactWork<Step::dim>& work) {
  const auto walls = step.walls(node);
  auto* motion = step.nodes.template write<mpm::Motion>(node);
  finish_node<Step::dim>(state, walls.any(), step.options.mass_damping, step.dt, work, motion);
  if (walls.is_held()) {
    work.constraint_impulse -= state.constraint_impulse;
    work.force -= state.constraint_impulse / step.dt;
  }
}

// Maps back the velocity of a node; returns the work as map_back does. touching: in contact with the ground.
template <class Step, class Node>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE double map_back_node(const Step& step, const Node& node, bool touching,
                                                          const Vector<double, Step::dim>& gravity) {
  if (!has_mass(step, node)) {
    return 0.0;
  }
  const GroundOfMappedBack<Step::dim> below{touching, step.options.distance_check,
                                            touching ? &step.ground(node).normal : nullptr,
                                            touching ? clearance_of(step, node) : 0.0};
  auto* velocity = step.nodes.template write<mpm::Velocity>(node);
  return map_back<Step::dim>(step.walls(node), below, gravity, step.dt, step.nodes.template read<mpm::Momentum>(node),
                             step.nodes.template read<mpm::Motion>(node), velocity);
}

}  // namespace thawslide::terrain
