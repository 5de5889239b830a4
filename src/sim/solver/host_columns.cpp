#include "sim/solver/host_columns.hpp"

#include <algorithm>
#include <memory>

#include "base/instances.hpp"
#include "mpm/nodes.hpp"

namespace thawslide::sim {

namespace {

// Host copy of a device's grid without particles, with the nodal values that band columns read.
template <int Dim>
struct NodesOfDevice {
  NodesOfDevice(double cell, const mpm::Mapping& mapping) : grid(cell, {}, mapping) {}

  mpm::SparseGrid<Dim> grid;
  terrain::GroundOnGrid<Dim> ground;
  mpm::Nodes<Dim> nodes;
  std::vector<std::uint32_t> requested_blocks;  // blocks whose nodes the device transfers
  std::vector<double> states;                   // records of BaseState of candidate nodes
};

// Updates the active blocks. Basal segments read nodes in blocks with candidate nodes and in adjacent blocks.
template <int Dim>
void update_blocks(const Model<Dim>& model, const std::vector<std::uint64_t>& keys, NodesOfDevice<Dim>& base) {
  constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);
  const auto near = [&](std::size_t b) { return base.ground.any_candidate(b); };
  base.grid.set_blocks(keys);
  base.ground.update(*model.ground, base.grid, model.substrates.get());
  base.nodes.near_ground.allocate(keys.size(), near);
  base.nodes.contact.allocate(keys.size(), near);
  base.nodes.momentum.resize(keys.size());
  base.nodes.motion.resize(keys.size());
  base.requested_blocks.clear();
  for (std::size_t b = 0; b < keys.size(); ++b) {
    std::fill_n(base.nodes.momentum.of_block(b), block_nodes, typename mpm::RecordsOf<mpm::Momentum, Dim>::Record{});
    const std::int32_t* about = base.grid.blocks_about_block(b);
    if (std::any_of(about, about + mpm::Tile<Dim>::stencil, [&](std::int32_t other) {
          return other != KeyIndex::absent && near(static_cast<std::size_t>(other));
        })) {
      base.requested_blocks.push_back(static_cast<std::uint32_t>(b));
    }
  }
}

template <int Dim>
void list_states(band::BasalSegments<Dim>& columns, NodesOfDevice<Dim>& base) {
  columns.to_nodes(base.grid, base.nodes);
  base.states.clear();
  for (std::size_t b = 0; b < base.grid.blocks().size(); ++b) {
    if (!base.ground.any_candidate(b)) {
      continue;
    }
    const auto& known = base.ground.block(b);
    for (std::size_t k = 0; k < known.size(); ++k) {
      if (known[k].candidate) {
        const auto& record = base.nodes.base_state(b, k);
        base.states.insert(base.states.end(), record.begin(), record.begin() + mpm::BaseState::size<Dim>);
      }
    }
  }
}

template <int Dim>
void set_nodes(const std::vector<double>& numbers, NodesOfDevice<Dim>& base) {
  constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);
  constexpr auto of_contact = static_cast<std::size_t>(mpm::Contact::size<Dim>);
  const double* record = numbers.data();
  for (const std::size_t b : base.requested_blocks) {
    for (std::size_t k = 0; k < block_nodes; ++k, record += device::column_record_size<Dim>) {
      if (base.nodes.contact.contains(b)) {
        std::copy_n(record, of_contact, base.nodes.contact.of_block(b)[k].begin());
      }
      base.nodes.momentum.of_block(b)[k][mpm::MomentumLayout<Dim>::mass] = record[of_contact];
      std::copy_n(record + of_contact + 1, Dim,
                  base.nodes.motion.of_block(b)[k].begin() + mpm::MotionLayout<Dim>::middle_velocity);
    }
  }
}

}  // namespace

template <int Dim>
device::HostColumns host_columns_of(const Setup<Dim>& setup, const Clock& clock, const double& dt, Base<Dim>& base) {
  if (!base.columns) {
    return {};
  }
  const auto below = std::make_shared<NodesOfDevice<Dim>>(setup.cell(), mapping_of(setup.model));
  return {[&setup, below](const std::vector<std::uint64_t>& blocks) {
            update_blocks(setup.model, blocks, *below);
            return below->requested_blocks;
          },
          [&base, below]() -> const std::vector<double>& {
            list_states(*base.columns, *below);
            return below->states;
          },
          [&setup, &clock, &dt, &base, below](const std::vector<double>& nodes) {
            set_nodes(nodes, *below);
            update_columns(setup, below->grid, below->ground, clock.time, dt, below->nodes, base);
          }};
}

#define THAWSLIDE_INSTANTIATE(Dim) \
  template device::HostColumns host_columns_of<Dim>(const Setup<Dim>&, const Clock&, const double&, Base<Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
