#include "terrain/contact.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "base/instances.hpp"
#include "terrain/block_step.hpp"
#include "terrain/contact_stage.hpp"

namespace thawslide::terrain {

namespace {

using mpm::BaseLoad, mpm::NodeAt;

template <int Dim>
inline constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);

// Nodes of a block that are in contact, and their places in it.
struct BlockContact {
  std::vector<std::size_t> node;
  std::vector<BasalNode> base;
};

// Finds the nodes of a block in contact, and evaluates the laws of the case. reads_mass: as in ContactModel, true for a
// law of the caller.
template <int Dim>
void find_contact(const BlockStep<Dim>& step, double cell, const ContactModel<Dim>& model, bool reads_mass,
                  BlockContact& contact) {
  contact.node.clear();
  contact.base.clear();
  const double smallest = smallest_area * (Dim == 2 ? cell : cell * cell);
  BasalNode base;
  for (std::size_t k = 0; k < step.candidates; ++k) {
    const double* columns = step.nodes.nodes.base_states.at(step.block, k);
    gather_basal_node(step, NodeAt{step.block, k}, smallest, model.law.gravity, reads_mass, columns, base);
    if (base.area > 0.0) {
      contact.node.push_back(k);
      contact.base.push_back(base);
    }
  }
  if (!contact.base.empty()) {
    evaluate_basal_law(model.law, contact.base);
  }
}

// Initializes a block without contact. known: ground at its nodes.
template <int Dim>
void start_block(const typename GroundOnGrid<Dim>::Block& known, std::size_t b, mpm::Nodes<Dim>& nodes) {
  for (std::size_t k = 0; k < block_nodes<Dim>; ++k) {
    nodes.contact.of_block(b)[k] = {known[k].candidate ? 1.0 : 0.0};
  }
}

// Strengths by a law of the caller: of all loaded nodes, and the first one of each block.
struct GivenStrengths {
  std::vector<std::size_t> first;
  LoadedNodes nodes;
};

// Collects the loaded nodes of all blocks on one thread, and calls the law.
template <int Dim>
GivenStrengths strengths_by(const StrengthLaw& law, const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>* ground,
                            const mpm::Constraints<Dim>& constraints, const ContactModel<Dim>& model, double time,
                            double dt, mpm::Nodes<Dim>& nodes) {
  GivenStrengths given;
  BlockContact contact;
  given.nodes.time = time;
  given.nodes.dt = dt;
  for (std::size_t b = 0; b < grid.blocks().size(); ++b) {
    given.first.push_back(given.nodes.strength.size());
    const BlockStep<Dim> step(grid, ground, constraints, model, time, dt, nodes, b);
    find_contact(step, grid.cell(), model, true, contact);
    for (std::size_t c = 0; c < contact.node.size(); ++c) {
      const NodeAt at{step.block, contact.node[c]};
      Vector<double, Dim> position = mpm::node_position(grid, at.block, at.node);
      position[Dim - 1] = step.ground(at).elevation;
      add_loaded_node<Dim>(position.data(), contact.base[c], model.law, given.nodes);
    }
  }
  replace_strengths(law, given.nodes);
  return given;
}

template <int Dim>
void apply_contact_conditions(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>* ground,
                              mpm::Nodes<Dim>& nodes) {
  nodes.contact.allocate(grid.blocks().size(),
                         [&](std::size_t b) { return ground != nullptr && ground->any_candidate(b); });
}

}  // namespace

template <int Dim>
void press_on_ground(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>& ground,
                     const mpm::Constraints<Dim>& constraints, const ContactModel<Dim>& model, double time, double dt,
                     mpm::Nodes<Dim>& nodes) {
  // by block: 1 if a node is loaded; persistent, to avoid allocation in each step
  thread_local std::vector<std::uint8_t> buffer;
  buffer.assign(grid.blocks().size(), 0);
  auto& loaded = buffer;  // the buffer of the calling thread, shared by all threads
  nodes.base.allocate(grid.blocks().size(), [&](std::size_t b) { return ground.any_candidate(b); });
  parallel_for(grid.blocks().size(), [&](std::size_t b) {
    if (!ground.any_candidate(b)) {
      return;
    }
    const BlockStep<Dim> step(grid, &ground, constraints, model, time, dt, nodes, b);
    std::fill_n(nodes.base.of_block(b), nodes.base.nodes, typename mpm::SparseRecordsOf<BaseLoad, Dim>::Record{});
    for (std::size_t k = 0; k < ground.candidates(b); ++k) {
      auto& base = nodes.base.of_block(b)[k];
      base[BaseLoad::load] = load_on_ground(step, NodeAt{b, k});
      if (base[BaseLoad::load] > 0.0) {
        loaded[b] = 1;
      }
    }
  });
  // Covered ground is also needed at nodes that a hovering mass does not reach, but only by adjacent loaded nodes.
  parallel_for(grid.blocks().size(), [&](std::size_t b) {
    const std::int32_t* about = grid.blocks_about_block(b);
    if (!ground.any_candidate(b) || std::none_of(about, about + mpm::Tile<Dim>::stencil, [&](std::int32_t other) {
          return other != KeyIndex::absent && loaded[static_cast<std::size_t>(other)] != 0;
        })) {
      return;
    }
    const BlockStep<Dim> step(grid, &ground, constraints, model, time, dt, nodes, b);
    for (std::size_t k = 0; k < ground.candidates(b); ++k) {
      nodes.base.of_block(b)[k][BaseLoad::covered] = covered_ground(step, NodeAt{b, k});
    }
  });
}

template <int Dim>
void start_contact(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>* ground, mpm::Nodes<Dim>& nodes) {
  apply_contact_conditions(grid, ground, nodes);
  parallel_for(grid.blocks().size(), [&](std::size_t b) {
    if (nodes.contact.contains(b)) {
      start_block(ground->block(b), b, nodes);
    }
  });
}

template <int Dim>
bool loads_bare_ground(const mpm::SparseGrid<Dim>& grid, const mpm::Nodes<Dim>& nodes) {
  return parallel_any(grid.blocks().size(), [&](std::size_t b) {
    for (std::size_t k = 0; nodes.base.contains(b) && k < nodes.base.nodes; ++k) {
      if (nodes.base(b, k)[BaseLoad::load] > 0.0 && !(nodes.base_states.at(b, k)[mpm::BaseState::area] > 0.0)) {
        return true;
      }
    }
    return false;
  });
}

template <int Dim>
ContactWork<Dim> resolve_contact(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>* ground,
                                 const mpm::Constraints<Dim>& constraints, const ContactModel<Dim>& model, double time,
                                 double dt, mpm::Nodes<Dim>& nodes, const BedOnGrid<Dim>* bed,
                                 const StrengthLaw* strength) {
  nodes.motion.resize(grid.blocks().size());
  apply_contact_conditions(grid, ground, nodes);
  std::optional<GivenStrengths> given;
  if (strength != nullptr && !model.base_is_fixed) {
    given = strengths_by(*strength, grid, ground, constraints, model, time, dt, nodes);
  }
  using Work = ContactWork<Dim>;
  return parallel_sum<Work>(grid.blocks().size(), [&](std::size_t b, Work& work) {
    const BlockStep<Dim> step(grid, ground, constraints, model, time, dt, nodes, b);
    thread_local BlockContact contact;  // persistent, to avoid allocation for each block
    if (step.candidates > 0) {
      start_block<Dim>(ground->block(b), b, nodes);
    }
    find_contact(step, grid.cell(), model, model.reads_mass || strength != nullptr, contact);
    for (std::size_t k = 0, c = 0; k < block_nodes<Dim>; ++k) {
      const NodeAt at{b, k};
      nodes.motion(at).fill(0.0);
      if (c < contact.node.size() && contact.node[c] == k) {
        ++c;
      } else if (has_mass(step, at)) {
        store_motion(step, at, trial_of(step, at), work);
      }
    }
    for (std::size_t c = 0; c < contact.node.size(); ++c) {
      const NodeAt at{b, contact.node[c]};
      const BasalNode& base = contact.base[c];
      const double of_base = model.base_is_fixed ? std::numeric_limits<double>::infinity()
                             : given             ? given->nodes.strength[given->first[b] + c]
                                                 : base.strength(model.law.clamp, model.law.cap_pressure);
      NodeState<Dim> state = trial_of(step, at);
      const auto below = bed != nullptr ? bed->below(at, base.area, of_base, dt, state.mass) : BedBelowNode<Dim>{};
      touch_ground(step, at, base, of_base, model.law.heat_fraction, below, state, work);
      store_motion(step, at, state, work);
    }
  });
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                               \
  template void start_contact<Dim>(const mpm::SparseGrid<Dim>&, const GroundOnGrid<Dim>*, mpm::Nodes<Dim>&);     \
  template void press_on_ground<Dim>(const mpm::SparseGrid<Dim>&, const GroundOnGrid<Dim>&,                      \
                                     const mpm::Constraints<Dim>&, const ContactModel<Dim>&, double, double,     \
                                     mpm::Nodes<Dim>&);                                                          \
  template bool loads_bare_ground<Dim>(const mpm::SparseGrid<Dim>&, const mpm::Nodes<Dim>&);                     \
  template ContactWork<Dim> resolve_contact<Dim>(const mpm::SparseGrid<Dim>&, const GroundOnGrid<Dim>*,          \
                                                 const mpm::Constraints<Dim>&, const ContactModel<Dim>&, double, \
                                                 double, mpm::Nodes<Dim>&, const BedOnGrid<Dim>*, const StrengthLaw*);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::terrain
