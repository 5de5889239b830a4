// A particle pass (mpm/particle_pass.hpp) as a device runs it: a group of threads a tile. A thread fetches a node's
// record; after a barrier a thread a particle runs the kernels; then a thread a node of a cell adds what the cell's
// particles carry, one after the other; then a thread a node adds what the cells bring, cell after cell, to the tile's
// patch. So no two threads write one number, and the sums have the order, and the bits, of the processor's.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "mpm/group.hpp"
#include "mpm/one_particle.hpp"
#include "mpm/particle_pass.hpp"
#include "mpm/particle_view.hpp"

namespace thawslide::mpm {

// A particle of a tile: itself, its nearest node and its cell.
template <int Dim>
struct TileParticle {
  std::uint32_t particle;
  std::array<std::int32_t, static_cast<std::size_t>(Dim)> nearest;
  std::size_t first_node, cell;  // the lowest node of the cell in the patch; number of the cell in the tile
};

template <int Dim, class Real>
std::vector<TileParticle<Dim>> particles_of_tile(const SparseGrid<Dim, Real>& grid, std::size_t tile) {
  std::vector<TileParticle<Dim>> all;
  for (const TileBatch<Dim, Real>& batch : grid.batches(tile)) {
    for (std::size_t lane = 0; lane < batch.count; ++lane) {
      TileParticle<Dim> one{batch.particle[lane], {}, static_cast<std::size_t>(batch.nodes.first[lane]), 0};
      for (std::size_t a = 0; a < Dim; ++a) {
        one.nearest[a] = batch.nearest[a][lane];
      }
      const bool goes_on = !all.empty() && all.back().first_node == one.first_node;
      one.cell = all.empty() ? 0 : all.back().cell + (goes_on ? 0 : 1);
      all.push_back(one);
    }
  }
  return all;
}

template <int Dim, class Real>
OnePlace<Dim, Real> place_of(const SparseGrid<Dim, Real>& grid, const HeldSides<Dim>& sides,
                             const Particles<Dim, Real>& particles, const TileParticle<Dim>& one) {
  OnePlace<Dim, Real> place{{}, one.first_node, {}};
  for (std::size_t a = 0; a < Dim; ++a) {
    const int axis = static_cast<int>(a);
    place.offset[axis] =
        particles.position(one.particle, axis) * grid.inverse_cell() - static_cast<Real>(one.nearest[a]);
    place.at_side[a] = one.nearest[a] == sides.lower[a] || one.nearest[a] == sides.upper[a];
  }
  return place;
}

template <int Dim, class Real>
OneWeights<Dim, Real> weights_of(const LinearWeights& /*weights*/, const SparseGrid<Dim, Real>& grid,
                                 const Particles<Dim, Real>& particles, const TileParticle<Dim>& one) {
  OneWeights<Dim, Real> of_one;
  of_one.set_linear(place_of(grid, HeldSides<Dim>{}, particles, one), grid.inverse_cell());
  return of_one;
}
template <class Shape, int Dim, class Real>
OneWeights<Dim, Real> weights_of(const MomentumWeights<Shape, Dim, Real>& weights, const SparseGrid<Dim, Real>& grid,
                                 const Particles<Dim, Real>& particles, const TileParticle<Dim>& one) {
  OneWeights<Dim, Real> of_one;
  const OnePlace<Dim, Real> place = place_of(grid, weights.sides, particles, one);
  of_one.set_linear(place, grid.inverse_cell());
  const HalfSize<Real> size = weights.sizes.of(particles, One<Real>{{one.particle}});
  of_one.template set_momentum<Shape>(place, size, grid.inverse_cell());
  return of_one;
}
template <class Shape, int Dim, class Real>
OneWeights<Dim, Real> weights_of(const AffineWeights<Shape, Dim, Real>& weights, const SparseGrid<Dim, Real>& grid,
                                 const Particles<Dim, Real>& particles, const TileParticle<Dim>& one) {
  const MomentumWeights<Shape, Dim, Real>& of_momentum = weights;
  OneWeights<Dim, Real> of_one = weights_of(of_momentum, grid, particles, one);
  of_one.template set_affine<Shape>(place_of(grid, weights.sides, particles, one), grid.cell(), grid.inverse_cell());
  return of_one;
}

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
  using CarriedTo = OneContribution<Real, Dim, Adding<Name, Dim, Real>::carried>;
  using Carried = ByName<Named<Adds, CarriedTo<Adds>>...>;
  static constexpr std::size_t cell_nodes = CellNodes<Dim>::count;
  static constexpr auto patch_nodes = static_cast<std::size_t>(Tile<Dim>::patch_nodes);

 public:
  GroupOnTile(HostGroup& group, const SparseGrid<Dim, Real>& grid, std::size_t tile)
      : group_(group),
        grid_(grid),
        tile_(tile),
        particles_(particles_of_tile(grid, tile)),
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
      for_cells_of(node, [&](std::size_t cell, std::size_t node_of_cell) {
        for (std::size_t c = 0; c < carried; ++c) {
          record[first + c] += cell_sums[(cell * cell_nodes + node_of_cell) * carried + c];
        }
      });
    });
  }

  template <class Name>
  Real sum_in_cell(std::size_t cell, std::size_t node, std::size_t component) const {
    const std::array<std::size_t, 3> along{node % 3, node / 3 % 3, node / 9};
    Real sum = Real(0);
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
template <class Weights, int Dim, class Real, class Records, class TakesTile, class... Kernels>
Accounts<Kernels...> group_pass(HostGroup& group, const SparseGrid<Dim, Real>& grid, const Weights& weights,
                                Particles<Dim, Real>& particles, Records& records, const TakesTile& takes_tile,
                                const Kernels&... kernels) {
  using Reads = AllOf<typename Kernels::Reads...>;
  using Adds = AllOf<typename Kernels::Adds...>;
  Accounts<Kernels...> sum{};
  for (std::size_t t = 0; t < grid.tiles().size(); ++t) {
    if (takes_tile(t)) {
      sum += GroupOnTile<Weights, Reads, Adds, Dim, Real, Kernels...>(group, grid, t)
                 .run(weights, particles, records, kernels...);
    }
  }
  return sum;
}

}  // namespace thawslide::mpm
