// Device kernels of nodes: contact with the ground and velocities mapped back, using the same functions as
// the CPU stages.
#pragma once

#include <limits>

#include "device/node_access.hpp"
#include "device/step_model.hpp"
#include "device/tile_tables.hpp"
#include "mpm/base_states.hpp"
#include "mpm/prescribed_motion.hpp"
#include "mpm/section_width.hpp"
#include "terrain/contact_stage.hpp"

namespace thawslide::device {

// Arguments common to all node kernels of a step.
template <int Dim>
struct NodeStageArgs {
  static constexpr int dim = Dim;
  static constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);

  TileTables<Dim> tables;
  ContactNodes<Dim> nodes;
  const terrain::GroundAtNode<Dim>* known;  // ground by node; null if there is none
  mpm::PrescribedMotion<Dim> motion;
  Vector<double, Dim> gravity;
  double cell, time, dt;
  terrain::ContactOptions options;
  std::uint64_t first_held_layer;  // of the grid, and those after it
  mpm::WidthView width;

  [[nodiscard]] THAWSLIDE_HD mpm::NodeConstraints<Dim> walls(std::size_t node) const {
    const bool held = mpm::Tile<Dim>::layer(tables.block_keys[node / block_nodes]) >= first_held_layer;
    const Vector<double, Dim> position = position_of_node<Dim>(tables.block_keys, node, cell);
    return {motion, position, time, held, motion.may_apply(position, position, time)};
  }
  [[nodiscard]] THAWSLIDE_HD const terrain::GroundAtNode<Dim>& ground(std::size_t node) const { return known[node]; }
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
    double* base = step.nodes.template write<mpm::BaseLoad>(node);
    base[mpm::BaseLoad::load] = terrain::load_on_ground(step, node);
    base[mpm::BaseLoad::covered] = terrain::covered_ground(step, node);
  }
};
template <int Dim>
struct GatherBasalNode {
  NodeStageArgs<Dim> step;
  const std::uint32_t* candidates;
  double smallest_area, gravity;
  mpm::BaseStates<Dim> columns;
  terrain::BasalNode* bases;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    constexpr std::size_t block_nodes = NodeStageArgs<Dim>::block_nodes;
    const std::size_t node = candidates[k];
    terrain::gather_basal_node(step, node, smallest_area, gravity, true,
                               columns.at(node / block_nodes, node % block_nodes), bases[k]);
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
  const double* strengths;  // by candidate [Pa], in place of those of the laws; null: none
  physics::FrictionClamp clamp;
  bool cap_pressure;
  double heat_fraction;
  Beds beds;

  THAWSLIDE_HD void visit(std::size_t node, Part& part) const {
    double* contact = step.nodes.template write<mpm::Contact>(node);
    clear<mpm::Motion>(step.nodes.template write<mpm::Motion>(node));
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
    const double strength = step.options.base_is_fixed ? std::numeric_limits<double>::infinity()
                            : strengths != nullptr     ? strengths[candidate]
                                                       : base.strength(clamp, cap_pressure);
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
    work += terrain::map_back_node(
        step, node, step.nodes.template read<mpm::Contact>(node)[mpm::Contact::touching] > 0.0, step.gravity);
  }
};

}  // namespace thawslide::device
