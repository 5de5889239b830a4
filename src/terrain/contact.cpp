#include "terrain/contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "base/instances.hpp"
#include "terrain/contact_node.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::terrain {

namespace {

using mpm::Averages;
using mpm::BaseLayout;
using mpm::MomentumLayout;
using mpm::NearGround;

// Contact nodes of one block, with the input of the basal law.
template <int Dim>
struct BlockContact {
  template <class T>
  using Column = typename BasalNodes::template Column<T>;

  BasalNodes basal;
  Column<std::size_t> node;
  Column<double> area;
  Column<NodeState<Dim>> state;
};

template <int Dim>
void add_contact_node(const mpm::Nodes<Dim>& nodes, std::size_t b, std::size_t k, double pressure, double dt,
                      const ContactModel<Dim>& model, bool reads_mass, const GroundAtNode<Dim>& ground,
                      const NodeState<Dim>& state, BlockContact<Dim>& contact) {
  const bool on_columns = model.band_columns && nodes.base_state(b, k)[mpm::BaseState::area] > 0.0;
  auto known = on_columns || !reads_mass
                   ? loaded_node<Dim>(pressure, ground.normal, state)
                   : contact_node_of(nodes.state(b, k), nodes.averages(b, k)[Averages::volume], nodes.near_ground(b, k),
                                     pressure, model.pore_pressure, ground.normal, state);
  if (model.band_columns) {
    set_columns_state(nodes.base_state(b, k), model.pore_pressure, known);
  }
  BasalNodes& basal = contact.basal;
  const std::size_t c = basal.count++;
  const double load = nodes.base(b, k)[BaseLayout::load];
  const double area = load / (pressure * dt);  // the basal area is divided among nodes in proportion to their loads
  contact.node[c] = k;
  contact.area[c] = area;
  contact.state[c] = state;
  basal.substrate[c] = ground.substrate;
  basal.normal_pressure[c] = known.normal_pressure;
  basal.pore_pressure[c] = known.pore_pressure;
  basal.saturation[c] = known.saturation;
  basal.solid_fraction[c] = known.solid_fraction;
  basal.temperature[c] = known.temperature;
  basal.slip[c] = known.slip;
  basal.speed[c] = known.speed;
  basal.unit_weight[c] = unit_weight_of<Dim>(nodes.momentum(b, k), model.law.gravity);
}

// Node `step` layers above a node of a block. block: absent if there is none.
struct NodeInColumn {
  std::int32_t block;
  std::size_t node;
};
template <int Dim>
NodeInColumn node_above(const mpm::SparseGrid<Dim>& grid, std::size_t b, std::size_t k, int step) {
  const auto adjacent = mpm::Tile<Dim>::adjacent(static_cast<int>(k), Dim - 1, step);
  return {grid.blocks_about_block(b)[adjacent.direction], static_cast<std::size_t>(adjacent.local)};
}

// Normal pressure [Pa] on the ground at a loaded node (Eq. 16), which also determines its contact area.
template <int Dim>
double normal_pressure(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>& ground, const mpm::Nodes<Dim>& nodes,
                       std::size_t b, std::size_t k, double dt) {
  using Record = std::remove_cvref_t<decltype(nodes.base(b, k))>;
  static constexpr Record none{};
  const double smallest = smallest_area * (Dim == 2 ? grid.cell() : grid.cell() * grid.cell());
  return pressure_of_column(dt, smallest, [&](int step) -> const Record& {
    const NodeInColumn found = node_above(grid, b, k, step);
    const auto block = static_cast<std::size_t>(found.block);
    return found.block != KeyIndex::absent && ground.any_candidate(block) ? nodes.base(block, found.node) : none;
  });
}

// Ground at the nodes of a block; null if it has no candidate node.
template <int Dim>
const typename GroundOnGrid<Dim>::Block* candidates_of(const GroundOnGrid<Dim>* ground, std::size_t b) {
  return ground != nullptr && ground->any_candidate(b) ? &ground->block(b) : nullptr;
}

// Finds the loaded nodes of a block with candidate nodes, and evaluates the laws of the case. reads_mass: as in
// ContactModel, true for a law of the caller. finish(state, k): called for all other nodes with mass.
template <int Dim, class Finish>
void find_contact(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>* ground, const ContactModel<Dim>& model,
                  bool reads_mass, const mpm::BlockConstraints<Dim>& on_block, std::size_t b, double time, double dt,
                  const mpm::Nodes<Dim>& nodes, BlockContact<Dim>& contact, const Finish& finish) {
  const auto* known = candidates_of(ground, b);
  constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);
  for (std::size_t k = 0; k < block_nodes; ++k) {
    if (!(nodes.momentum(b, k)[MomentumLayout<Dim>::mass] > 0.0)) {
      continue;
    }
    const mpm::NodeConstraints<Dim> walls{on_block, k};
    const auto state = trial_state<Dim>(walls, dt, model.mass_damping, nodes.momentum(b, k));
    if (known != nullptr && nodes.base(b, k)[BaseLayout::load] > 0.0) {
      add_contact_node(nodes, b, k, normal_pressure(grid, *ground, nodes, b, k, dt), dt, model, reads_mass, (*known)[k],
                       state, contact);
    } else {
      finish(state, k);
    }
  }
  evaluate_basal_law(model.law, time, contact.basal);
}

// Covered fraction of the ground at a node of layer 0.
template <int Dim>
double covered_fraction_at(const mpm::SparseGrid<Dim>& grid, const mpm::SectionWidth& width,
                           const mpm::Nodes<Dim>& nodes, std::size_t b, std::size_t k) {
  const double cell = grid.cell();
  const double space = (Dim == 2 ? width.at(mpm::node_position(grid, b, k)[0]) : cell) * cell * cell;
  return covered_fraction(space, [&](int step) {
    const NodeInColumn found = node_above(grid, b, k, step);
    return found.block == KeyIndex::absent
               ? 0.0
               : nodes.momentum(static_cast<std::size_t>(found.block), found.node)[MomentumLayout<Dim>::volume];
  });
}

// Initializes a block without contact. known: ground at its nodes.
template <int Dim>
void start_block(const typename GroundOnGrid<Dim>::Block& known, std::size_t b, mpm::Nodes<Dim>& nodes) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<Dim>::nodes); ++k) {
    nodes.contact.of_block(b)[k] = {known[k].candidate ? 1.0 : 0.0};
  }
}

// Strengths by a law of the caller: of all loaded nodes, and the first one of each block.
struct GivenStrengths {
  std::vector<std::size_t> first;
  LoadedNodes nodes;
};

template <int Dim>
void add_loaded_nodes(const mpm::SparseGrid<Dim>& grid, const typename GroundOnGrid<Dim>::Block& known, std::size_t b,
                      const BlockContact<Dim>& contact, LoadedNodes& nodes) {
  const BasalNodes& basal = contact.basal;
  const auto append = [&](auto& all, const auto& column) {
    all.insert(all.end(), column.begin(), column.begin() + static_cast<std::ptrdiff_t>(basal.count));
  };
  for (std::size_t c = 0; c < basal.count; ++c) {
    Vector<double, Dim> position = mpm::node_position(grid, b, contact.node[c]);
    position[Dim - 1] = known[contact.node[c]].elevation;
    nodes.position.insert(nodes.position.end(), position.data(), position.data() + Dim);
  }
  append(nodes.area, contact.area);
  append(nodes.substrate, basal.substrate);
  append(nodes.normal_pressure, basal.normal_pressure);
  append(nodes.pore_pressure, basal.pore_pressure);
  append(nodes.temperature, basal.temperature);
  append(nodes.saturation, basal.saturation);
  append(nodes.solid_fraction, basal.solid_fraction);
  append(nodes.slip, basal.slip);
  append(nodes.speed, basal.speed);
  append(nodes.unit_weight, basal.unit_weight);
  append(nodes.strength, basal.strength);
}

// Collects the loaded nodes of all blocks on one thread, and calls the law.
template <int Dim>
GivenStrengths strengths_by(const StrengthLaw& law, const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>* ground,
                            const mpm::Constraints<Dim>& constraints, const ContactModel<Dim>& model, double time,
                            double dt, const mpm::Nodes<Dim>& nodes) {
  GivenStrengths given;
  given.nodes.time = time;
  given.nodes.dt = dt;
  for (std::size_t b = 0; b < grid.blocks().size(); ++b) {
    given.first.push_back(given.nodes.strength.size());
    if (const auto* known = candidates_of(ground, b); known != nullptr) {
      BlockContact<Dim> contact;
      find_contact(grid, ground, model, true, mpm::BlockConstraints<Dim>(grid, constraints, b, time), b, time, dt,
                   nodes, contact, [](const NodeState<Dim>& /*state*/, std::size_t /*k*/) {});
      add_loaded_nodes(grid, *known, b, contact, given.nodes);
    }
  }
  const std::size_t count = given.nodes.strength.size();
  law(given.nodes);
  THAWSLIDE_ASSERT(given.nodes.strength.size() == count, "{} strengths of {} nodes", given.nodes.strength.size(),
                   count);
  return given;
}

// Counts the force on a node of a held body as one of the ground, which holds it.
template <int Dim>
void hold_by_ground(const NodeState<Dim>& state, double dt, ContactWork<Dim>& work) {
  work.constraint_impulse -= state.constraint_impulse;
  work.force -= state.constraint_impulse / dt;
}

template <int Dim>
void apply_contact_conditions(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>* ground,
                              mpm::Nodes<Dim>& nodes) {
  nodes.contact.allocate(grid.blocks().size(), [&](std::size_t b) { return candidates_of(ground, b) != nullptr; });
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
    const mpm::BlockConstraints<Dim> on_block(grid, constraints, b, time);
    std::fill_n(nodes.base.of_block(b), nodes.base.nodes, typename mpm::SparseRecords<Dim, BaseLayout::size>::Record{});
    for (std::size_t k = 0; k < ground.candidates(b); ++k) {
      auto& base = nodes.base.of_block(b)[k];
      const GroundAtNode<Dim>& known = ground.block(b)[k];
      const auto& record = nodes.momentum(b, k);
      if (record[MomentumLayout<Dim>::mass] > 0.0) {
        const mpm::NodeConstraints<Dim> walls{on_block, k};
        const auto state = trial_state<Dim>(walls, dt, model.mass_damping, record);
        base[BaseLayout::load] =
            known.bend * approach(model.distance_check,
                                  clearance_along_normal(known.normal, nodes.near_ground(b, k)[NearGround::clearance]),
                                  dt, state.mass, state.momentum.dot(known.normal));
        if (base[BaseLayout::load] > 0.0) {
          loaded[b] = 1;
        }
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
    for (std::size_t k = 0; k < ground.candidates(b); ++k) {
      const GroundAtNode<Dim>& known = ground.block(b)[k];
      if (known.area > 0.0) {
        nodes.base.of_block(b)[k][BaseLayout::covered] =
            known.area * covered_fraction_at(grid, model.width, nodes, b, k);
      }
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
      if (nodes.base(b, k)[BaseLayout::load] > 0.0 && !(nodes.base_state(b, k)[mpm::BaseState::area] > 0.0)) {
        return true;
      }
    }
    return false;
  });
}

template <int Dim>
ContactWork<Dim> resolve_contact(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>* ground,
                                 const mpm::Constraints<Dim>& constraints, const ContactModel<Dim>& model, double time,
                                 double dt, mpm::Nodes<Dim>& nodes, const Bed<Dim>* bed, const StrengthLaw* strength) {
  constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);
  nodes.motion.resize(grid.blocks().size());
  apply_contact_conditions(grid, ground, nodes);
  if (bed != nullptr) {
    bed->distribute(grid, nodes);
  }
  std::optional<GivenStrengths> given;
  if (strength != nullptr && !model.base_is_fixed) {
    given = strengths_by(*strength, grid, ground, constraints, model, time, dt, nodes);
  }
  using Work = ContactWork<Dim>;
  return parallel_sum<Work>(grid.blocks().size(), [&](std::size_t b, Work& work) {
    const mpm::BlockConstraints<Dim> on_block(grid, constraints, b, time);
    const auto* known = candidates_of(ground, b);
    if (known != nullptr) {
      start_block(*known, b, nodes);
    }
    for (std::size_t k = 0; k < block_nodes; ++k) {
      nodes.motion(b, k).fill(0.0);
    }
    const auto finish = [&](const NodeState<Dim>& state, std::size_t k) {
      finish_node<Dim>(state, on_block.any(), model.mass_damping, dt, work, nodes.motion(b, k));
      if (on_block.is_held()) {
        hold_by_ground(state, dt, work);
      }
    };
    BlockContact<Dim> contact;
    find_contact(grid, ground, model, model.reads_mass || strength != nullptr, on_block, b, time, dt, nodes, contact,
                 finish);
    for (std::size_t c = 0; c < contact.basal.count; ++c) {
      const std::size_t k = contact.node[c];
      const double limit = model.base_is_fixed ? std::numeric_limits<double>::infinity()
                           : given             ? given->nodes.strength[given->first[b] + c]
                                               : contact.basal.strength[c];
      const BedBelowNode<Dim> below{bed != nullptr ? &bed->material() : nullptr,
                                    bed != nullptr ? nodes.bed.of_block(b)[k].data() : nullptr,
                                    contact.area[c],
                                    limit,
                                    dt,
                                    contact.state[c].mass};
      const ContactConditions<Dim> conditions{
          (*known)[k].normal,       nodes.base(b, k)[BaseLayout::load], (*known)[k].bend, contact.area[c], limit,
          contact.basal.friction[c]};
      apply_contact(mpm::NodeConstraints<Dim>{on_block, k}, conditions, model.law.heat_fraction, dt, below,
                    contact.state[c], work, nodes.contact.of_block(b)[k]);
      finish(contact.state[c], k);
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
                                                 double, mpm::Nodes<Dim>&, const Bed<Dim>*, const StrengthLaw*);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::terrain
