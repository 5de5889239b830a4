// Pass over all particles: kernels that are independent of each other's sums share the weights, the loaded records and
// the scatter of each batch.
#pragma once

#include <algorithm>
#include <tuple>
#include <type_traits>

#include "mpm/body_sizes.hpp"
#include "mpm/cell_sums.hpp"
#include "mpm/kernel.hpp"
#include "mpm/nodes.hpp"

namespace thawslide::mpm {

// Shape functions of momentum with their parameters.
template <int Dim>
struct MomentumWeights {
  ShapeFunction shape;
  const BodySizes& sizes;  // of particles, in cells
  const PrescribedSides<Dim>& sides;
};
// Linear shape functions for all records of a pass.
struct LinearWeights {};

// Weights of a batch.
template <class Weights, int Dim>
struct BatchWeights;
template <int Dim>
struct BatchWeights<LinearWeights, Dim> {
  LinearStencil<Dim> linear;
  MappingAt<Dim, Simd<double>> linear_mapping;

  THAWSLIDE_ALWAYS_INLINE BatchWeights(const LinearWeights& /*weights*/, const SparseGrid<Dim>& grid,
                                       const Particles<Dim>& particles, const TileBatch<Dim>& batch)
      : linear(linear_stencil(grid, particles, batch)), linear_mapping(grid.mapping(), particles.linear_slope, batch) {}
  template <class Functions>
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE const auto& of() const {
    static_assert(std::is_same_v<Functions, LinearFunctions>, "this pass has linear shape functions alone");
    return linear;
  }
  template <class Functions>
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE const auto& mapping_of() const {
    return linear_mapping;
  }
};
template <int Dim>
struct BatchWeights<MomentumWeights<Dim>, Dim> {
  BatchStencil<Dim> momentum;
  LinearStencil<Dim> linear;
  MappingAt<Dim, Simd<double>> mapping, linear_mapping;

  THAWSLIDE_ALWAYS_INLINE BatchWeights(const MomentumWeights<Dim>& weights, const SparseGrid<Dim>& grid,
                                       const Particles<Dim>& particles, const TileBatch<Dim>& batch)
      : BatchWeights(weights, grid, particles, batch, grid_position(grid, particles, batch)) {}
  template <class Functions>
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE const auto& of() const {
    if constexpr (std::is_same_v<Functions, LinearFunctions>) {
      return linear;
    } else {
      return momentum;
    }
  }
  template <class Functions>
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE const auto& mapping_of() const {
    if constexpr (std::is_same_v<Functions, LinearFunctions>) {
      return linear_mapping;
    } else {
      return mapping;
    }
  }

 private:
  THAWSLIDE_ALWAYS_INLINE BatchWeights(const MomentumWeights<Dim>& weights, const SparseGrid<Dim>& grid,
                                       const Particles<Dim>& particles, const TileBatch<Dim>& batch,
                                       const BatchGridPosition<Dim>& at)
      : momentum(make_stencil(weights.shape, grid, batch, at, weights.sizes.of(particles, batch), weights.sides)),
        linear{at.offset, batch.nodes, grid.inverse_cell()},
        mapping(grid.mapping(), particles.ground_slope, batch),
        linear_mapping(grid.mapping(), particles.linear_slope, batch) {}
};

// Weights of momentum with those of APIC.
template <int Dim>
struct AffineWeights : MomentumWeights<Dim> {};
template <int Dim>
struct BatchWeights<AffineWeights<Dim>, Dim> : BatchWeights<MomentumWeights<Dim>, Dim> {
  using Base = BatchWeights<MomentumWeights<Dim>, Dim>;
  AffineBatch<Dim> affine;

  THAWSLIDE_ALWAYS_INLINE BatchWeights(const AffineWeights<Dim>& weights, const SparseGrid<Dim>& grid,
                                       const Particles<Dim>& particles, const TileBatch<Dim>& batch)
      : Base(weights, grid, particles, batch),
        affine(make_affine(weights.shape, grid, this->momentum, grid_position(grid, particles, batch), weights.sides)) {
  }
  template <class Functions>
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE const auto& of() const {
    if constexpr (std::is_same_v<Functions, AffineFunctions>) {
      return affine.nodes;
    } else {
      return Base::template of<Functions>();
    }
  }
  using Square = Matrix<Simd<double>, Dim>;
  // Gradients in space to gradients on the grid; and the same times the second moments.
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE Square affine_on_grid(const Square& gradient) const {
    return this->mapping.on_grid(gradient);
  }
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE Square affine_moment(const Square& gradient) const {
    return affine_on_grid(gradient) * affine.moment.asDiagonal();
  }
};

// Gather of a batch from the surrounding records.
template <class Weights, class Patches>
struct BatchGather {
  const Weights& weights;
  const Patches& patches;

  // `Count` components of a record from `first` on: interpolated values and gradients.
  template <class Name, std::size_t Count>
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE auto read(std::size_t first = 0) const {
    return weights.template mapping_of<typename Name::Functions>().in_space(
        read_nodes<Count>(weights.template of<typename Name::Functions>(), patches.template of<Name>(), first));
  }
  // Records of Planes, for contributions to min-reduced components.
  template <class Name>
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE auto planes() const {
    return &patches.template of<Name>();
  }
  // Values of all components of a record, without gradients.
  template <class Name>
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE auto values() const {
    return read_values(weights.template of<typename Name::Functions>(), patches.template of<Name>());
  }
};

// Contributions of batches to a record, and their sums in a tile.
template <class Name, int Dim>
struct PartialSums {
  static constexpr int size = components_of<Name, Dim>;
  static constexpr std::size_t first = first_in_register<Name, Dim>;
  static constexpr std::size_t carried = scatter_size<Name, Dim>;
  static constexpr bool has_flux = Name::flux != no_flux;
  static_assert(first == 0 || carried <= record_step);
  using Carried = Contribution<Dim, carried>;
  using Sums = std::conditional_t<std::is_same_v<typename Name::Functions, LinearFunctions>,
                                  LinearCellSums<has_flux, first, carried, Dim, size>,
                                  CellSums<Name::flux, first, carried, Dim, size>>;
};
template <IsMinReduced Name, int Dim>
struct PartialSums<Name, Dim> {
  static_assert(part_of<Name, Dim>.count == 1);
  using Carried = GapsOfBatch<Dim>;
  using Sums = PatchMinima<part_of<Name, Dim>.from, Dim, components_of<Name, Dim>>;
};
template <class Name, int Dim>
using SumsOf = typename PartialSums<Name, Dim>::Sums;

// Gather and scatter of a tile's particles.
template <class Reads, class Adds, int Dim>
class TileScatter;
template <class... Reads, class... Adds, int Dim>
class TileScatter<RecordList<Reads...>, RecordList<Adds...>, Dim> {
  using Patches = ByName<Named<Reads, PatchOf<Reads, Dim>>...>;

 public:
  template <class Records>
  TileScatter([[maybe_unused]] const SparseGrid<Dim>& grid, [[maybe_unused]] std::size_t tile,
              [[maybe_unused]] Records& records)
      : sums_{{SumsOf<Adds, Dim>(cleared<Adds>(records, grid, tile), grid.rows_seen(tile))}...} {
    (load_patch(grid, tile, records.template of<Reads>(), patches_.template of<Reads>()), ...);
  }

  template <class Weights>
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE BatchGather<Weights, Patches> seen(const Weights& weights) const {
    return {weights, patches_};
  }

  using Scatter = ByName<Named<Adds, typename PartialSums<Adds, Dim>::Carried>...>;
  template <class Weights>
  THAWSLIDE_ALWAYS_INLINE void add([[maybe_unused]] const Weights& weights, [[maybe_unused]] std::size_t count,
                                   [[maybe_unused]] Scatter& added) {
    (map_fluxes<Adds>(weights, added.template of<Adds>()), ...);
    (sums_.template of<Adds>().add(weights.template of<typename Adds::Functions>(), count, added.template of<Adds>()),
     ...);
  }
  // Skips a batch.
  THAWSLIDE_ALWAYS_INLINE void skip() { (sums_.template of<Adds>().skip(), ...); }

 private:
  template <class Name, class Records>
  static auto& cleared(Records& records, const SparseGrid<Dim>& grid, std::size_t tile) {
    auto& patch = records.template of<Name>().patches(grid.tiles().size())[tile];
    if constexpr (!OfAnOwner<Name>) {
      patch.clear(grid.rows_seen(tile));
    }
    return patch;
  }

  Patches patches_;
  ByName<Named<Adds, SumsOf<Adds, Dim>>...> sums_;
};

// Sums over particles, by kernel.
template <class... Kernels>
struct TotalsOf : std::tuple<typename Kernels::Totals...> {
  TotalsOf& operator+=(const TotalsOf& part) {
    [&]<std::size_t... K>(std::index_sequence<K...>) { ((std::get<K>(*this) += std::get<K>(part)), ...); }
    (std::index_sequence_for<Kernels...>());
    return *this;
  }
};

// Kernel of a tile; kernels that depend on the tile provide in_tile(tile).
template <class Kernel>
THAWSLIDE_ALWAYS_INLINE decltype(auto) in_tile(const Kernel& kernel, std::size_t tile) {
  if constexpr (requires { kernel.in_tile(tile); }) {
    return kernel.in_tile(tile);
  } else {
    return (kernel);
  }
}

// True if a pass accepts a batch or particle with these nodes in an accepted tile. nodes: of a batch, or the place of a
// particle's lowest node. Filters without accepts(tile, nodes) accept all.
template <class TileFilter, class Nodes>
THAWSLIDE_ALWAYS_INLINE bool accepts_nodes(const TileFilter& accepts, std::size_t tile, const Nodes& nodes) {
  if constexpr (std::is_invocable_v<const TileFilter&, std::size_t, const Nodes&>) {
    return accepts(tile, nodes);
  } else {
    return true;
  }
}

// Allocates the patches of records.
template <class... Names, class Records>
void acquire_patches(RecordList<Names...> /*names*/, [[maybe_unused]] std::size_t tiles,
                     [[maybe_unused]] Records& records) {
  (static_cast<void>(records.template of<Names>().patches(tiles)), ...);
}

// Compile-time check of a pass's records.
template <class Reads, class Adds, int Dim>
constexpr void check_records() {
  static_assert(all_apart<Adds, Dim>, "particles add to these components of a record in different ways");
  static_assert(one_record<Adds>, "the patches of two records would share memory");
  static_assert(are_disjoint<Reads, Adds>, "no record is read in the pass that adds to it: it has no sums yet");
}

// Runs kernels over the particles of the tiles that accepts(t) selects, restricted by accepts(t, nodes) if defined.
// Each batch is passed to all kernels in turn. Contributions are left in the patches, for a node_pass to sum. Records:
// of Nodes.
template <class Weights, int Dim, class Records, class TileFilter, class... Kernels>
TotalsOf<Kernels...> particle_pass(const SparseGrid<Dim>& grid, const Weights& weights, Particles<Dim>& particles,
                                   Records& records, const TileFilter& accepts, const Kernels&... kernels) {
  using Reads = AllOf<typename Kernels::Reads...>;
  using Adds = AllOf<typename Kernels::Adds...>;
  check_records<Reads, Adds, Dim>();
  acquire_patches(Adds{}, grid.tiles().size(), records);
  return parallel_sum<TotalsOf<Kernels...>>(grid.tiles().size(), [&](std::size_t t, TotalsOf<Kernels...>& totals) {
    if (!accepts(t)) {
      return;
    }
    TileScatter<Reads, Adds, Dim> work(grid, t, records);
    const auto run = [&]<std::size_t... K>(std::index_sequence<K...> /*kernels*/, const auto&... of_tile) {
      for (const TileBatch<Dim>& batch : grid.batches(t)) {
        if (!accepts_nodes(accepts, t, batch.nodes)) {
          work.skip();
          continue;
        }
        const BatchWeights<Weights, Dim> of_batch(weights, grid, particles, batch);
        typename TileScatter<Reads, Adds, Dim>::Scatter added;
        (of_tile(particles, batch, work.seen(of_batch), added, std::get<K>(totals)), ...);
        work.add(of_batch, batch.count, added);
      }
    };
    run(std::index_sequence_for<Kernels...>(), in_tile(kernels, t)...);
  });
}

// Runs a kernel that neither reads nor adds to nodes over all particles in memory order; returns its totals. A batch
// can contain particles of several tiles and materials.
template <int Dim, class Kernel>
typename Kernel::Totals for_particles_in_memory(Particles<Dim>& particles, const Kernel& kernel) {
  static_assert(std::is_same_v<typename Kernel::Reads, RecordList<>> &&
                std::is_same_v<typename Kernel::Adds, RecordList<>>);
  using Totals = typename Kernel::Totals;
  constexpr std::size_t chunk = 1024;
  const std::size_t tasks = (particles.size() + chunk - 1) / chunk;
  return parallel_sum<Totals>(tasks, [&](std::size_t task, Totals& totals) {
    const ByName<> seen{};
    ByName<> added{};
    const std::size_t last = std::min(particles.size(), (task + 1) * chunk);
    for (std::size_t p = task * chunk; p < last; p += SimdBatch::most) {
      kernel(particles, batch_in_memory(p, last), seen, added, totals);
    }
  });
}

}  // namespace thawslide::mpm
