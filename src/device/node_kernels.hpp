// Device kernels of nodes: contact with the ground and velocities mapped back, using the same functions as
// the CPU stages.
#pragma once

#include <limits>

#include "device/step_model.hpp"
#include "device/tile_tables.hpp"
#include "mpm/records.hpp"
#include "mpm/section_width.hpp"
#include "terrain/contact_stage.hpp"

namespace thawslide::device {

// Records of nodes, accessed by the node's number over all blocks.
template <int Dim>
struct NodeViews {
  double *averages, *state, *momentum, *near_ground, *base, *contact, *motion, *velocity;
  const terrain::GroundAtNode<Dim>* known;  // null: no ground

  [[nodiscard]] THAWSLIDE_HD static std::size_t node(std::size_t block, std::size_t in_block) {
    return block * static_cast<std::size_t>(mpm::Tile<Dim>::nodes) + in_block;
  }
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

// Prescribed motion at one node; as mpm::NodeConstraints.
template <int Dim>
struct WallsOfNode {
  const mpm::PrescribedMotion<Dim>& motion;
  Vector<double, Dim> position;
  double time;
  bool holds;  // the node belongs to a held body

  [[nodiscard]] THAWSLIDE_HD bool any() const { return holds || motion.may_apply(position, position, time); }
  [[nodiscard]] THAWSLIDE_HD bool is_held() const { return holds; }
  THAWSLIDE_HD bool apply(double mass, Vector<double, Dim>& momentum) const {
    if (holds) {
      momentum.setZero();
      return false;
    }
    return motion.apply(position, mass, time, momentum);
  }
};

// Arguments common to all node kernels of a step.
template <int Dim>
struct NodeStageArgs {
  static constexpr int dim = Dim;
  static constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);

  TileTables<Dim> tables;
  NodeViews<Dim> nodes;
  mpm::PrescribedMotion<Dim> motion;
  Vector<double, Dim> gravity;
  double cell, time, dt;
  terrain::ContactOptions options;
  std::uint64_t first_held_layer;  // of the grid, and those after it
  mpm::WidthView width;

  [[nodiscard]] THAWSLIDE_HD WallsOfNode<Dim> walls(std::size_t node) const {
    const bool holds = mpm::Tile<Dim>::layer(tables.block_keys[node / block_nodes]) >= first_held_layer;
    return {motion, position_of_node<Dim>(tables.block_keys, node, cell), time, holds};
  }
  [[nodiscard]] THAWSLIDE_HD const terrain::GroundAtNode<Dim>& ground(std::size_t node) const {
    return nodes.known[node];
  }
  [[nodiscard]] THAWSLIDE_HD double space(std::size_t node) const {
    return (Dim == 2 ? width.at(position_of_node<Dim>(tables.block_keys, node, cell)[0]) : cell) * cell * cell;
  }
  THAWSLIDE_HD bool find_above(std::size_t node, int step, std::size_t& found) const {
    constexpr auto stencil = static_cast<std::size_t>(mpm::Tile<Dim>::stencil);
    const auto adjacent = mpm::Tile<Dim>::adjacent(static_cast<int>(node % block_nodes), Dim - 1, step);
    const std::int32_t block =
        tables.blocks_about_block[node / block_nodes * stencil + static_cast<std::size_t>(adjacent.direction)];
    found = static_cast<std::size_t>(block) * block_nodes + static_cast<std::size_t>(adjacent.local);
    return block != absent;
  }
};

// Kernels with one thread per candidate node (terrain/contact_stage.hpp): load on the ground and covered area; input of
// the basal laws.
template <int Dim>
struct PressOnGround {
  NodeStageArgs<Dim> step;
  const std::uint32_t* candidates;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    const std::size_t node = candidates[k];
    double* base = step.nodes.base_at(node);
    base[mpm::BaseLayout::load] = terrain::load_on_ground(step, node);
    base[mpm::BaseLayout::covered] = terrain::covered_ground(step, node);
  }
};
template <int Dim>
struct GatherBasalNode {
  NodeStageArgs<Dim> step;
  const std::uint32_t* candidates;
  double smallest_area, gravity;
  const double* columns;  // records of BaseState by candidate; null without band columns
  terrain::BasalNode* bases;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    const double* state = columns != nullptr ? columns + k * mpm::BaseState::size<Dim> : nullptr;
    const std::size_t node = candidates[k];
    terrain::gather_basal_node(step, node, smallest_area, gravity, true, state, bases[k]);
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
  const terrain::BasalNode* bases;
  physics::FrictionClamp clamp;
  bool cap_pressure;
  double heat_fraction;
  Beds beds;

  THAWSLIDE_HD void visit(std::size_t node, Part& part) const {
    const NodeViews<Dim>& nodes = step.nodes;
    double* contact = nodes.contact_at(node);
    clear<mpm::Motion>(nodes.motion_at(node));
    clear<mpm::Contact>(contact);
    const std::int32_t candidate = number != nullptr ? number[node] : absent;
    contact[mpm::Contact::candidate] = candidate != absent ? 1.0 : 0.0;
    if (!terrain::has_mass(step, node)) {
      return;
    }
    auto state = terrain::trial_of(step, node);
    if (candidate != absent && bases[candidate].area > 0.0) {
      part.touches = true;
      touch(static_cast<std::size_t>(candidate), node, state, part.contact);
    }
    terrain::store_motion(step, node, state, part.motion);
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
  THAWSLIDE_HD void touch(std::size_t candidate, std::size_t node, terrain::NodeState<Dim>& state, Sum& work) const {
    const terrain::BasalNode& base = bases[candidate];
    const double strength =
        step.options.base_is_fixed ? std::numeric_limits<double>::infinity() : base.strength(clamp, cap_pressure);
    terrain::touch_ground(step, node, base, strength, heat_fraction,
                          beds.below(candidate, base.area, strength, step.dt, state.mass), state, work);
  }
};

// Velocities from the momentum that particles map back.
template <int Dim>
struct MapBack {
  using Totals = double;

  NodeStageArgs<Dim> step;

  THAWSLIDE_HD void operator()(std::size_t node, double& work) const {
    work += terrain::map_back_node(step, node, step.nodes.contact_at(node)[mpm::Contact::touching] > 0.0, step.gravity);
  }
};

}  // namespace thawslide::device
