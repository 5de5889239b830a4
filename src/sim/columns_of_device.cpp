// Band columns of a simulation on a device: the columns are computed on the CPU.
#include <algorithm>

#include "band/basal_segments.hpp"
#include "base/instances.hpp"
#include "device/solver.hpp"
#include "device/step_model.hpp"
#include "sim/grid_of_device.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

namespace {

using mpm::BaseState, mpm::Contact;

// Updates the active blocks. Basal segments read nodes in blocks with candidate nodes and in adjacent blocks.
template <int Dim>
void update_blocks(const Model<Dim>& model, const std::vector<std::uint64_t>& keys, GridOfDevice<Dim>& base) {
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
void list_states(band::BasalSegments<Dim>& columns, GridOfDevice<Dim>& base) {
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
        base.states.insert(base.states.end(), record.begin(), record.begin() + BaseState::size<Dim>);
      }
    }
  }
}

template <int Dim>
void set_nodes(const std::vector<Real>& numbers, GridOfDevice<Dim>& base) {
  constexpr auto block_nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);
  constexpr auto of_contact = static_cast<std::size_t>(Contact::size<Dim>);
  const Real* record = numbers.data();
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
device::HostColumns Simulation<Dim>::host_columns() {
  if (!band_columns_) {
    return {};
  }
  grid_of_device_ = std::make_unique<GridOfDevice<Dim>>(grid_.cell(), grid_.mapping());
  return {[this](const std::vector<std::uint64_t>& blocks) {
            update_blocks(model_, blocks, *grid_of_device_);
            return grid_of_device_->requested_blocks;
          },
          [this]() -> const std::vector<Real>& {
            list_states(*band_columns_, *grid_of_device_);
            return grid_of_device_->states;
          },
          [this](const std::vector<Real>& nodes) {
            set_nodes(nodes, *grid_of_device_);
            band_columns_follow(grid_of_device_->grid, grid_of_device_->ground, grid_of_device_->nodes);
          }};
}

#define THAWSLIDE_INSTANTIATE(Dim) template device::HostColumns Simulation<Dim>::host_columns();
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
