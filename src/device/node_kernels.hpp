// Device kernels of nodes: nodal state, contact with the ground and velocities mapped back, using the same functions as
// the CPU stages.
#pragma once

#include <limits>

#include "band/averages_kernel.hpp"
#include "band/heat_face.hpp"
#include "device/step_model.hpp"
#include "device/tile_tables.hpp"
#include "mpm/records.hpp"
#include "physics/basal/laws.hpp"
#include "physics/contact.hpp"
#include "terrain/contact_node.hpp"

namespace thawslide::device {

// Records of nodes, accessed by the node's number over all blocks.
template <int Dim>
struct NodeViews {
  double *averages, *state, *momentum, *near_ground, *base, *contact, *motion, *velocity;
  const terrain::GroundAtNode<Dim>* known;  // null: no ground

  template <class Name>
  [[nodiscard]] THAWSLIDE_HD static double* record(double* numbers, std::size_t node) {
    return numbers + node * mpm::record_size(mpm::components_of<Name, Dim>);
  }
  [[nodiscard]] THAWSLIDE_HD double* averages_at(std::size_t node) const {
    return record<mpm::Averages>(averages, node);
  }
  [[nodiscard]] THAWSLIDE_HD double* state_at(std::size_t node) const { return record<mpm::NodalState>(state, node); }
  [[nodiscard]] THAWSLIDE_HD double* momentum_at(std::size_t node) const {
    return record<mpm::Momentum>(momentum, node);
  }
  [[nodiscard]] THAWSLIDE_HD double* near_ground_at(std::size_t node) const {
    return record<mpm::NearGround>(near_ground, node);
  }
  [[nodiscard]] THAWSLIDE_HD double* base_at(std::size_t node) const { return base + node * base_size; }
  [[nodiscard]] THAWSLIDE_HD double* contact_at(std::size_t node) const { return record<mpm::Contact>(contact, node); }
  [[nodiscard]] THAWSLIDE_HD double* motion_at(std::size_t node) const { return record<mpm::Motion>(motion, node); }
  [[nodiscard]] THAWSLIDE_HD double* velocity_at(std::size_t node) const {
    return record<mpm::Velocity>(velocity, node);
  }

  static constexpr std::size_t base_size = mpm::BaseLayout::size;
};

// Position [m, relative to the domain's lower corner] of a node, by its number over all blocks.
template <int Dim>
THAWSLIDE_HD Vector<double, Dim> position_of_node(const std::uint64_t* block_keys, std::size_t node, double cell) {
  using T = mpm::Tile<Dim>;
  constexpr auto block_nodes = static_cast<std::size_t>(T::nodes);
  const typename T::Index index =
      T::node(T::index(block_keys[node / block_nodes]), static_cast<int>(node % block_nodes));
  Vector<double, Dim> position;
  for (int a = 0; a < Dim; ++a) {
    position[a] = static_cast<double>(index[static_cast<std::size_t>(a)]) * cell;
  }
  return position;
}

// Faces of the domain at one node.
template <int Dim>
struct FacesAtNode {
  const mpm::DomainFaces<Dim>& faces;
  Vector<double, Dim> position;

  [[nodiscard]] THAWSLIDE_HD bool any() const {
    for (int a = 0; a < Dim; ++a) {
      if ((faces.at_lower(position[a], a) && faces.faces[2 * a] != mpm::BoundaryKind::open) ||
          (faces.at_upper(position[a], a) && faces.faces[2 * a + 1] != mpm::BoundaryKind::open)) {
        return true;
      }
    }
    return false;
  }
  THAWSLIDE_HD bool apply(double /*mass*/, Vector<double, Dim>& momentum) const {
    faces.apply_faces(position, momentum);
    return false;
  }
};

// Arguments common to all node kernels of a step.
template <int Dim>
struct NodeStageArgs {
  static constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);

  TileTables<Dim> tables;
  NodeViews<Dim> nodes;
  mpm::DomainFaces<Dim> faces;
  Vector<double, Dim> gravity;
  double cell, mass_damping, time, dt;
  bool distance_check, pore_pressure, base_is_fixed;

  [[nodiscard]] THAWSLIDE_HD FacesAtNode<Dim> walls(std::size_t node) const {
    return {faces, position_of_node<Dim>(tables.block_keys, node, cell)};
  }
  [[nodiscard]] THAWSLIDE_HD terrain::NodeState<Dim> trial(std::size_t node) const {
    return terrain::trial_state<Dim>(walls(node), dt, mass_damping,
                                     static_cast<const double*>(nodes.momentum_at(node)));
  }
  [[nodiscard]] THAWSLIDE_HD bool has_mass(std::size_t node) const {
    return nodes.momentum_at(node)[mpm::MomentumLayout<Dim>::mass] > 0.0;
  }
  // Clearance of a candidate node along the normal of the ground [m].
  [[nodiscard]] THAWSLIDE_HD double clearance_along_normal(std::size_t node) const {
    return terrain::clearance_along_normal(nodes.known[node].normal,
                                           nodes.near_ground_at(node)[mpm::NearGround::clearance]);
  }
  // Finds the node `step` layers above a node. Returns false if there is no such block.
  THAWSLIDE_HD bool find_above(std::size_t node, int step, std::size_t& found) const {
    constexpr auto stencil = static_cast<std::size_t>(mpm::Tile<Dim>::stencil);
    const auto adjacent = mpm::Tile<Dim>::adjacent(static_cast<int>(node % block_nodes), Dim - 1, step);
    const std::int32_t block =
        tables.blocks_about_block[node / block_nodes * stencil + static_cast<std::size_t>(adjacent.direction)];
    found = static_cast<std::size_t>(block) * block_nodes + static_cast<std::size_t>(adjacent.local);
    return block != absent;
  }
};

// Sets the temperature and pore pressure of a node, with prescribed temperatures on faces of the domain.
template <int Dim>
struct SetState {
  NodeViews<Dim> nodes;
  const std::uint64_t* block_keys;
  band::HeatFaces<Dim> faces;
  bool has_faces;
  double cell;

  THAWSLIDE_HD void operator()(std::size_t node) const {
    double* state = nodes.state_at(node);
    if (band::set_nodal_state<Dim>(static_cast<const double*>(nodes.averages_at(node)), state) && has_faces) {
      band::prescribe_temperature(faces.at(position_of_node<Dim>(block_keys, node, cell)), state);
    }
  }
};

// Load of a candidate node on the ground, and the ground area that the sliding mass covers.
template <int Dim>
struct PressOnGround {
  NodeStageArgs<Dim> step;
  const std::uint32_t* candidates;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    const std::size_t node = candidates[k];
    const terrain::GroundAtNode<Dim>& known = step.nodes.known[node];
    double* base = step.nodes.base_at(node);
    base[mpm::BaseLayout::load] = 0.0;
    if (step.has_mass(node)) {
      const auto state = step.trial(node);
      base[mpm::BaseLayout::load] =
          known.bend * terrain::approach(step.distance_check, step.clearance_along_normal(node), step.dt, state.mass,
                                         state.momentum.dot(known.normal));
    }
    base[mpm::BaseLayout::covered] = 0.0;
    if (known.area > 0.0) {
      const double cell = step.cell;
      base[mpm::BaseLayout::covered] =
          known.area * terrain::covered_fraction(Dim == 2 ? cell * cell : cell * cell * cell, [&](int above) {
            std::size_t other = 0;
            return step.find_above(node, above, other) ? step.nodes.momentum_at(other)[mpm::MomentumLayout<Dim>::volume]
                                                       : 0.0;
          });
    }
  }
};

// Input of the basal laws at a candidate node, and their results.
struct ContactInput {
  physics::basal::ContactNode node;
  double area;  // [m2]; 0: not in contact
  // mu_e, pore pressure that reduces friction [Pa], drag [Pa], c_S [Pa]
  double friction, relief, drag, cohesion;
};

template <int Dim>
struct GatherContactInput {
  NodeStageArgs<Dim> step;
  const std::uint32_t* candidates;
  double smallest_area, gravity;
  const double* columns;  // records of BaseState by candidate; null without band columns
  ContactInput* bases;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    using mpm::BaseLayout;
    const std::size_t node = candidates[k];
    const NodeViews<Dim>& nodes = step.nodes;
    ContactInput& base = bases[k];
    base.area = 0.0;
    const double load = nodes.base_at(node)[BaseLayout::load];
    if (!step.has_mass(node) || !(load > 0.0)) {
      return;
    }
    const Vector<double, Dim>& normal = nodes.known[node].normal;
    const double none[BaseLayout::size] = {};
    const double pressure = terrain::pressure_of_column(step.dt, smallest_area, [&](int above) -> const double* {
      std::size_t other = 0;
      return step.find_above(node, above, other) ? nodes.base_at(other) : none;
    });
    base.area = load / (pressure * step.dt);  // the basal area is divided among nodes in proportion to their loads
    base.node = terrain::contact_node_of<Dim>(
        static_cast<const double*>(nodes.state_at(node)), nodes.averages_at(node)[mpm::Averages::volume],
        static_cast<const double*>(nodes.near_ground_at(node)), pressure, step.pore_pressure, normal, step.trial(node));
    if (columns != nullptr) {
      terrain::set_columns_state(columns + k * mpm::BaseState::size<Dim>, step.pore_pressure, base.node);
    }
    base.node.time = step.time;
    base.node.unit_weight = terrain::unit_weight_of<Dim>(static_cast<const double*>(nodes.momentum_at(node)), gravity);
  }
};

// Friction and cohesion by the laws of one substrate, at its nodes.
template <class Law, int Dim>
struct EvaluateFriction {
  Law law;
  int substrate;
  const terrain::GroundAtNode<Dim>* known;
  const std::uint32_t* candidates;
  ContactInput* bases;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    ContactInput& base = bases[k];
    if (known[candidates[k]].substrate == substrate && base.area > 0.0) {
      base.friction = law.coefficient(base.node);
      base.drag = physics::basal::drag_of(law, base.node);
      base.relief = Law::depends_on_pore_pressure ? base.node.pore_pressure : 0.0;
    }
  }
};
template <class Law, int Dim>
struct EvaluateCohesion {
  Law law;
  int substrate;
  const terrain::GroundAtNode<Dim>* known;
  const std::uint32_t* candidates;
  ContactInput* bases;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    ContactInput& base = bases[k];
    if (known[candidates[k]].substrate == substrate && base.area > 0.0) {
      base.cohesion = law.cohesion(base.node);
    }
  }
};

// Used when there is no erodible bed.
struct NoBeds {
  [[nodiscard]] THAWSLIDE_HD terrain::NoBed below(std::size_t /*candidate*/, double /*area*/, double /*strength*/,
                                                  double /*dt*/, double /*mass*/) const {
    return {};
  }
};

// From nodal momentum and force to nodal motion. Beds provides below(candidate, area, strength, dt, mass), the bed
// argument of apply_contact.
template <class Beds, int Dim>
struct ResolveContact {
  struct Part {
    terrain::ContactWork<Dim> contact, motion;
    bool touches = false;
  };
  using Sum = terrain::ContactWork<Dim>;

  NodeStageArgs<Dim> step;
  const std::int32_t* number;  // by node, index among candidates; null: no ground
  const ContactInput* bases;
  physics::FrictionClamp clamp;
  bool cap_pressure;
  double heat_fraction;
  Beds beds;

  THAWSLIDE_HD void visit(std::size_t node, Part& part) const {
    const NodeViews<Dim>& nodes = step.nodes;
    double* motion = nodes.motion_at(node);
    double* contact = nodes.contact_at(node);
    clear<mpm::Motion>(motion);
    clear<mpm::Contact>(contact);
    const std::int32_t candidate = number != nullptr ? number[node] : absent;
    contact[mpm::Contact::candidate] = candidate != absent ? 1.0 : 0.0;
    if (!step.has_mass(node)) {
      return;
    }
    auto state = step.trial(node);
    const FacesAtNode<Dim> walls = step.walls(node);
    if (candidate != absent && bases[candidate].area > 0.0) {
      part.touches = true;
      touch(static_cast<std::size_t>(candidate), node, walls, state, part.contact, contact);
    }
    terrain::finish_node<Dim>(state, walls.any(), step.mass_damping, step.dt, part.motion, motion);
  }

  // Adds nodes in contact after the others.
  THAWSLIDE_HD void add(const Part* parts, std::size_t count, Sum& sum) const {
    for (std::size_t k = 0; k < count; ++k) {
      if (!parts[k].touches) {
        sum += parts[k].motion;
      }
    }
    for (std::size_t k = 0; k < count; ++k) {
      if (parts[k].touches) {
        sum += parts[k].contact;
        sum += parts[k].motion;
      }
    }
  }

 private:
  template <class Name>
  THAWSLIDE_HD static void clear(double* record) {
    for (std::size_t c = 0; c < mpm::record_size(mpm::components_of<Name, Dim>); ++c) {
      record[c] = 0.0;
    }
  }
  THAWSLIDE_HD void touch(std::size_t candidate, std::size_t node, const FacesAtNode<Dim>& walls,
                          terrain::NodeState<Dim>& state, Sum& work, double* contact) const {
    const ContactInput& base = bases[candidate];
    const double sliding = physics::sliding_strength(base.friction, base.node.normal_pressure, base.relief,
                                                     base.cohesion, clamp, cap_pressure) +
                           base.drag;
    const double strength = step.base_is_fixed ? std::numeric_limits<double>::infinity() : sliding;
    const terrain::GroundAtNode<Dim>& known = step.nodes.known[node];
    const terrain::ContactConditions<Dim> conditions{
        known.normal, step.nodes.base_at(node)[mpm::BaseLayout::load], known.bend, base.area, strength, base.friction};
    terrain::apply_contact(walls, conditions, heat_fraction, step.dt,
                           beds.below(candidate, base.area, strength, step.dt, state.mass), state, work, contact);
  }
};

// Velocities from the momentum that particles map back.
template <int Dim>
struct MapBack {
  using Part = double;
  using Sum = double;

  NodeStageArgs<Dim> step;

  THAWSLIDE_HD void visit(std::size_t node, Part& work) const {
    const NodeViews<Dim>& nodes = step.nodes;
    if (!step.has_mass(node)) {
      return;
    }
    const bool touching = nodes.contact_at(node)[mpm::Contact::touching] > 0.0;
    const terrain::GroundOfMappedBack<Dim> below{touching, step.distance_check,
                                                 touching ? &nodes.known[node].normal : nullptr,
                                                 touching ? step.clearance_along_normal(node) : 0.0};
    double* velocity = nodes.velocity_at(node);
    work = terrain::map_back<Dim>(step.walls(node), below, step.gravity, step.dt,
                                  static_cast<const double*>(nodes.momentum_at(node)),
                                  static_cast<const double*>(nodes.motion_at(node)), velocity);
  }
  THAWSLIDE_HD void add(const Part* parts, std::size_t count, Sum& sum) const {
    for (std::size_t k = 0; k < count; ++k) {
      sum += parts[k];
    }
  }
};

}  // namespace thawslide::device
