// A particle pass (mpm/particle_pass.hpp) as a device runs it: a group of threads a tile. A thread fetches a node's
// record; after a barrier a thread a particle runs the kernels; then a thread a node of a cell adds what the cell's
// particles carry, one after the other; then a thread a node adds what the cells bring, cell after cell, to the tile's
// patch; what is lowered takes the smallest number instead. So no two threads write one number, and the sums have the
// order, and the bits, of the processor's.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "mpm/group.hpp"
#include "mpm/particle_pass.hpp"
#include "mpm/particle_view.hpp"
#include "mpm/tile_particles.hpp"

namespace thawslide::mpm {

// A patch in shared memory.
template <class Name, int Dim, class Real>
struct SharedPatch {
  static constexpr std::size_t size = record_size(components_of<Name, Dim>);
  SharedMemory<Real> numbers{static_cast<std::size_t>(Tile<Dim>::patch_nodes) * size};
};

// A tile on the device: what its threads share. One record after the other is added to, each with room of its own.
template <class Weights, class Reads, class Adds, int Dim, class Real, class... Kernels>
class GroupOnTile;
template <class Weights, class... Reads, class... Adds, int Dim, class Real, class... Kernels>
class GroupOnTile<Weights, RecordList<Reads...>, RecordList<Adds...>, Dim, Real, Kernels...> {
  using Patches = ByName<Named<Reads, SharedPatch<Reads, Dim, Real>>...>;
  template <class Name>
  using CarriedTo = CarriedByOne<Name, Dim, Real>;
  using Carried = ByName<Named<Adds, CarriedTo<Adds>>...>;
  static constexpr std::size_t cell_nodes = CellNodes<Dim>::count;
  static constexpr auto patch_nodes = static_cast<std::size_t>(Tile<Dim>::patch_nodes);

 public:
  template <class Takes>
  GroupOnTile(HostGroup& group, const SparseGrid<Dim, Real>& grid, std::size_t tile, const Takes& takes)
      : group_(group),
        grid_(grid),
        tile_(tile),
        particles_(particles_of_tile(grid, tile, takes)),
        carried_(particles_.size()),
        weights_(particles_.size()),
        accounts_(particles_.size()) {
    for (Carried& carried : carried_) {
      (carried.template of<Adds>().fill(std::numeric_limits<Real>::signaling_NaN()), ...);
    }
  }

  template <class Records>
  Accounts<Kernels...> run(const Weights& weights, Particles<Dim, Real>& particles, Records& records,
                           const Kernels&... kernels) {
    group_.begin();
    (fetch<Reads>(records), ...);
    group_.barrier();
    group_.each(particles_.size(), [&](std::size_t k) { visit(k, weights, particles, kernels...); });
    group_.barrier();
    (add<Adds>(records), ...);
    group_.end();
    Accounts<Kernels...> sum{};
    for (const auto& account : accounts_) {
      sum += account;
    }
    return sum;
  }

 private:
  // A thread a node.
  template <class Name, class Records>
  void fetch(Records& records) {
    group_.each(patch_nodes, [this, &records](std::size_t node) {
      constexpr std::size_t size = SharedPatch<Name, Dim, Real>::size;
      const auto& from = records.template of<Name>()(node_at(node));
      std::copy_n(from.begin(), size, &patches_.template of<Name>().numbers[node * size]);
    });
  }

  // A thread a particle.
  void visit(std::size_t k, const Weights& weights, Particles<Dim, Real>& particles, const Kernels&... kernels) {
    weights_[k] = weights_of(weights, grid_, particles, particles_[k]);
    const SeenByOne<OneWeights<Dim, Real>, Patches> seen{weights_[k], patches_};
    ParticleView<Dim, Real> view = view_of(particles);
    const One<Real> at{{particles_[k].particle}};
    carried_[k] = {};
    accounts_[k] = {};
    [&]<std::size_t... K>(std::index_sequence<K...>) {
      (in_tile(kernels, tile_)(view, at, seen, carried_[k], std::get<K>(accounts_[k])), ...);
    }
    (std::index_sequence_for<Kernels...>());
  }

  // A thread a node of a cell, then a thread a node of the patch.
  template <class Name, class Records>
  void add(Records& records) {
    constexpr std::size_t size = record_size(components_of<Name, Dim>), first = Adding<Name, Dim, Real>::first;
    constexpr std::size_t carried = CarriedTo<Name>::size;
    auto& cell_sums = cell_sums_.template of<Name>();
    const std::size_t cells = particles_.empty() ? 0 : particles_.back().cell + 1;
    cell_sums = SharedMemory<Real>(cells * cell_nodes * carried);
    group_.each(cells * cell_nodes, [this, &cell_sums](std::size_t k) {
      for (std::size_t c = 0; c < carried; ++c) {
        cell_sums[k * carried + c] = sum_in_cell<Name>(k / cell_nodes, k % cell_nodes, c);
      }
    });
    group_.barrier();
    auto& patch = records.template of<Name>().patches(grid_.tiles().size())[tile_];
    group_.each(patch_nodes, [this, &cell_sums, &patch](std::size_t node) {
      auto& record = patch.records[node];
      for (std::size_t c = 0; c < size && !OfAnOwner<Name>; ++c) {
        record[c] = Real(0);
      }
      for (std::size_t c = 0; c < carried && IsLowered<Name>; ++c) {
        record[first + c] = start<Name>;
      }
      for_cells_of(node, [&](std::size_t cell, std::size_t node_of_cell) {
        for (std::size_t c = 0; c < carried; ++c) {
          const Real brought = cell_sums[(cell * cell_nodes + node_of_cell) * carried + c];
          record[first + c] = IsLowered<Name> ? min(record[first + c], brought) : record[first + c] + brought;
        }
      });
    });
  }

  // Of a sum, or of what is lowered.
  template <class Name>
  static constexpr Real start = IsLowered<Name> ? std::numeric_limits<Real>::max() : Real(0);

  template <class Name>
  Real sum_in_cell(std::size_t cell, std::size_t node, std::size_t component) const {
    const std::array<std::size_t, 3> along{node % 3, node / 3 % 3, node / 9};
    Real sum = start<Name>;
    for (std::size_t k = 0; k < particles_.size(); ++k) {
      if (particles_[k].cell == cell) {
        const auto& stencil = weights_[k].template of<typename Name::Functions>();
        sum = add_particle(stencil, along, carried_[k].template of<Name>(), Adding<Name, Dim, Real>::has_flux,
                           component, sum);
      }
    }
    return sum;
  }

  // Calls visit(cell, node of the cell) for the cells, in order, that see a node of the patch.
  template <class Visit>
  void for_cells_of(std::size_t node, const Visit& visit) const {
    for (std::size_t k = 0; k < particles_.size(); ++k) {
      if (k > 0 && particles_[k].cell == particles_[k - 1].cell) {
        continue;
      }
      for (std::size_t n = 0; n < cell_nodes; ++n) {
        if (particles_[k].first_node + CellNodes<Dim>::place(n) == node) {
          visit(particles_[k].cell, n);
        }
      }
    }
  }

  // The node of the grid at a place of the patch.
  [[nodiscard]] NodeAt node_at(std::size_t place) const {
    NodeAt found{};
    const std::int32_t* blocks = grid_.blocks_about_tile(tile_);
    for_each_direction<Dim>([&](auto d) {
      for_shared_nodes<Dim, d>([&](std::size_t in_block, std::size_t in_patch) {
        if (in_patch == place) {
          found = {static_cast<std::size_t>(blocks[d]), in_block};
        }
      });
    });
    return found;
  }

  HostGroup& group_;
  const SparseGrid<Dim, Real>& grid_;
  std::size_t tile_;
  std::vector<TileParticle<Dim>> particles_;
  Patches patches_;
  ByName<Named<Adds, SharedMemory<Real>>...> cell_sums_;
  std::vector<Carried> carried_;
  std::vector<OneWeights<Dim, Real>> weights_;
  std::vector<Accounts<Kernels...>> accounts_;
};

// As particle_pass.
template <class Weights, int Dim, class Real, class Records, class Takes, class... Kernels>
Accounts<Kernels...> group_pass(HostGroup& group, const SparseGrid<Dim, Real>& grid, const Weights& weights,
                                Particles<Dim, Real>& particles, Records& records, const Takes& takes,
                                const Kernels&... kernels) {
  using Reads = AllOf<typename Kernels::Reads...>;
  using Adds = AllOf<typename Kernels::Adds...>;
  check_records<Reads, Adds, Dim>();
  Accounts<Kernels...> sum{};
  for (std::size_t t = 0; t < grid.tiles().size(); ++t) {
    if (takes(t)) {
      sum += GroupOnTile<Weights, Reads, Adds, Dim, Real, Kernels...>(group, grid, t, takes)
                 .run(weights, particles, records, kernels...);
    }
  }
  return sum;
}

}  // namespace thawslide::mpm
