#include "band/heat.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "band/heat_kernels.hpp"
#include "band/heat_nodes.hpp"
#include "base/instances.hpp"
#include "mpm/particle_pass.hpp"

namespace thawslide::band {

namespace {

using mpm::every_tile, mpm::NodeAt;

template <int Dim>
NodalHeat solve_with_tangent(const mpm::SparseGrid<Dim>& grid, const BandModel<Dim>& model, double dt, bool first_step,
                             mpm::Nodes<Dim>& nodes) {
  using mpm::HeatRates;
  nodes.heat_rates.resize(grid.blocks().size());
  nodes.unreached_heat.allocate(grid.blocks().size(), [&](std::size_t b) { return nodes.contact.contains(b); });
  const SolveTemperatureRate<Dim> solve{grid, model, dt, first_step};
  return mpm::node_pass<NodalHeat>(
      grid, [&](std::size_t b) { return mpm::sum_block<HeatRates>(grid, b, nodes); },
      [&](const NodeAt& at, NodalHeat& sum) {
        const auto& rates = nodes.heat_rates(at);
        solve(nodes, at, rates[HeatRates::capacity], rates[HeatRates::subgrid], sum);
      });
}

// In blocks with temperature changes, patches contain the sums of particles with their secant capacity. Other patches
// still contain the sums with the tangent capacity; rates there are unchanged except for face conditions. Returns the
// heat through faces [J].
template <int Dim>
double solve_with_secant(const mpm::SparseGrid<Dim>& grid, const BandModel<Dim>& model, double dt, bool first_step,
                         mpm::Nodes<Dim>& nodes) {
  using mpm::HeatRates;
  const auto& changing = nodes.marks.changing_blocks;
  nodes.secant_rates.allocate(grid.blocks().size(), [&](std::size_t b) { return changing[b] != 0; });
  const SolveTemperatureRate<Dim> solve{grid, model, dt, first_step};
  const NodalHeat solved = mpm::node_pass<NodalHeat>(
      grid,
      [&](std::size_t b) {
        if (changing[b] == 0) {
          return solve.has_faces ? mpm::rows_seen_in_block(grid, b) : 0;
        }
        return sum_patches_in_block(grid, b, nodes.heat_rates.patches(grid.tiles().size()),
                                    nodes.secant_rates.of_block(b), every_tile);
      },
      [&](const NodeAt& at, NodalHeat& sum) {
        const auto& rates = changing[at.block] != 0 ? nodes.secant_rates(at) : nodes.heat_rates(at);
        solve(nodes, at, rates[HeatRates::capacity], rates[HeatRates::subgrid], sum);
      });
  return solved.gain.boundary;
}

// Marks the tiles in which the temperature of a particle may change by more than is negligible, and the blocks around
// them.
template <int Dim, class Law>
void find_changes(const mpm::SparseGrid<Dim>& grid, const Law& law, double dt, const mpm::Particles<Dim>& particles,
                  mpm::Nodes<Dim>& nodes) {
  const auto half_negligible = [&](auto change) { return law.content.is_negligible(2.0 * change); };
  constexpr std::size_t own_block = static_cast<std::size_t>(mpm::Tile<Dim>::stencil) / 2;
  auto& marks = nodes.marks;
  marks.changing_tiles.resize(grid.tiles().size());
  parallel_for(grid.tiles().size(), [&](std::size_t t) {
    const auto warms = [&](const auto& node) { return !half_negligible(dt * node[mpm::NodalState::temperature_rate]); };
    const auto any_seen_warms = [&] {
      mpm::PatchOf<mpm::NodalState, Dim> state;
      load_patch(grid, t, nodes.state, state);
      return state.rows_with(grid.rows_seen(t), warms) != 0;
    };
    const auto* own = nodes.state.of_block(static_cast<std::size_t>(grid.blocks_about_tile(t)[own_block]));
    const auto any_of_own_warms = [&] {
      constexpr int edge = mpm::Tile<Dim>::edge;
      for (auto rows = mpm::rows_in_block<Dim, own_block>(grid.rows_seen(t)); rows != 0; rows &= rows - 1) {
        const auto* row = own + std::countr_zero(rows) * edge;
        if (std::any_of(row, row + edge, warms)) {
          return true;
        }
      }
      return false;
    };
    const auto& batches = grid.batches(t);
    const bool changes = any_of_own_warms() ||
                         std::any_of(batches.begin(), batches.end(),
                                     [&](const auto& batch) {
                                       return any(!half_negligible(particles.conduction_in_cell.load(batch)));
                                     }) ||
                         any_seen_warms();
    marks.changing_tiles[t] = changes ? 1 : 0;
  });
  grid.mark_blocks_about(marks.changing_tiles, marks.changing_blocks);
}

// Filter for tiles, and their batches, in reach of nodes that have friction heat but no linear weight.
template <int Dim>
struct SeesUnreachedHeat {
  const mpm::SparseGrid<Dim>& grid;
  const mpm::SparseRecordsOf<mpm::UnreachedHeat, Dim>& unreached_heat;
  std::vector<std::uint64_t>& rows;  // by tile: rows of its patch (Tile::rows_from) with such heat

  [[nodiscard]] bool operator()(std::size_t tile) const {
    mpm::PatchOf<mpm::UnreachedHeat, Dim> heat;
    load_patch(grid, tile, unreached_heat, heat);
    rows[tile] = heat.rows_with(grid.rows_seen(tile), [](const auto& record) { return record[0] != 0.0; });
    return rows[tile] != 0;
  }
  [[nodiscard]] bool operator()(std::size_t tile, const mpm::BatchNodes& nodes) const {
    return std::any_of(nodes.first.begin(), nodes.first.end(),
                       [&](std::int32_t lowest) { return (mpm::Tile<Dim>::rows_from(lowest) & rows[tile]) != 0; });
  }
};

// Distributes the friction heat of nodes without linear weight to the particles in their reach.
template <int Dim>
void redistribute_unreached_heat(const mpm::SparseGrid<Dim>& grid, const BandModel<Dim>& model, double dt,
                                 mpm::Nodes<Dim>& nodes, mpm::Particles<Dim>& particles) {
  thread_local std::vector<std::uint64_t> rows;  // persistent, to avoid allocation in each step
  rows.resize(grid.tiles().size());
  const SeesUnreachedHeat<Dim> sees_heat{grid, nodes.unreached_heat, rows};
  const mpm::MomentumWeights<Dim> weights{model.shape, model.sizes, model.sides};
  mpm::particle_pass(grid, weights, particles, nodes, sees_heat, RedistributeUnreachedHeat<Dim>{dt});
}

}  // namespace

template <int Dim>
HeatGain conduct_heat(const mpm::SparseGrid<Dim>& grid, const BandModel<Dim>& model, double dt, bool first_step,
                      mpm::Nodes<Dim>& nodes, mpm::Particles<Dim>& particles) {
  return with_particle_heat(model, [&](const auto& law) {
    using Law = std::decay_t<decltype(law)>;
    const auto pass = [&](const auto& tile_filter, const auto& kernel) {
      return std::get<0>(mpm::particle_pass(grid, mpm::LinearWeights{}, particles, nodes, tile_filter, kernel));
    };
    const double from_porosity = model.current_masses ? pass(every_tile, UpdateHeatMass<Dim, Law>{law}) : 0.0;
    const bool subgrid = model.secant_capacity && !first_step;
    pass(every_tile, HeatFlows<Dim, Law>{model, model.hydraulic(), law, dt, grid.inverse_cell(), subgrid});
    NodalHeat solved = solve_with_tangent(grid, model, dt, first_step, nodes);
    if (model.secant_capacity) {
      find_changes(grid, law, dt, particles, nodes);
      const auto changes = [&](std::size_t t) { return nodes.marks.changing_tiles[t] != 0; };
      pass(changes, SecantCapacity<Dim, Law>{law, dt});
      solved.gain.boundary = solve_with_secant(grid, model, dt, first_step, nodes);
    }
    HeatGain gain = solved.gain;
    if (solved.unreached_nodes > 0) {
      redistribute_unreached_heat(grid, model, dt, nodes, particles);
    }
    if (model.secant_capacity) {
      pass(every_tile, UpdateHeat<Dim, Law>{model, law, dt});
    } else {
      gain.capacity = pass(every_tile, UpdateHeatApparentCapacity<Dim, Law>{model, law, dt});
    }
    gain.porosity = from_porosity;
    return gain;
  });
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                      \
  template HeatGain conduct_heat<Dim>(const mpm::SparseGrid<Dim>&, const BandModel<Dim>&, double, bool, \
                                      mpm::Nodes<Dim>&, mpm::Particles<Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
