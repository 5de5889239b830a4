// One visit to all particles: kernels that need nothing of one another's sums run particle by particle, on weights made
// once, records fetched once and sums added once.
#pragma once

#include <tuple>

#include "mpm/body_sizes.hpp"
#include "mpm/cell_sums.hpp"
#include "mpm/kernel.hpp"
#include "mpm/nodes.hpp"

namespace thawslide::mpm {

// What ties particles to the nodes in a pass: the shape functions of momentum, with what they depend on.
template <class Shape, int Dim, class Real>
struct MomentumWeights {
  const BodySizes<Real>& sizes;  // of particles, in cells
  const HeldSides<Dim>& sides;
};
// A pass all of whose records go by the linear shape functions.
struct LinearWeights {};

// The weights of a batch.
template <class Weights, int Dim, class Real>
struct BatchWeights;
template <int Dim, class Real>
struct BatchWeights<LinearWeights, Dim, Real> {
  LinearStencil<Dim, Real> linear;

  THAWSLIDE_ALWAYS_INLINE BatchWeights(const LinearWeights& /*weights*/, const SparseGrid<Dim, Real>& grid,
                                       const Particles<Dim, Real>& particles, const TileBatch<Dim, Real>& batch)
      : linear(linear_stencil(grid, particles, batch)) {}
  template <class Functions>
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE const auto& of() const {
    static_assert(std::is_same_v<Functions, LinearFunctions>, "this pass has linear shape functions alone");
    return linear;
  }
};
template <class Shape, int Dim, class Real>
struct BatchWeights<MomentumWeights<Shape, Dim, Real>, Dim, Real> {
  BatchStencil<Dim, Real> momentum;
  LinearStencil<Dim, Real> linear;

  THAWSLIDE_ALWAYS_INLINE BatchWeights(const MomentumWeights<Shape, Dim, Real>& weights,
                                       const SparseGrid<Dim, Real>& grid, const Particles<Dim, Real>& particles,
                                       const TileBatch<Dim, Real>& batch)
      : BatchWeights(weights, grid, particles, batch, place_of(grid, particles, batch)) {}
  template <class Functions>
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE const auto& of() const {
    if constexpr (std::is_same_v<Functions, LinearFunctions>) {
      return linear;
    } else {
      return momentum;
    }
  }

 private:
  THAWSLIDE_ALWAYS_INLINE BatchWeights(const MomentumWeights<Shape, Dim, Real>& weights,
                                       const SparseGrid<Dim, Real>& grid, const Particles<Dim, Real>& particles,
                                       const TileBatch<Dim, Real>& batch, const BatchPlace<Dim, Real>& place)
      : momentum(make_stencil<Shape>(grid, batch, place, weights.sizes.of(particles, batch), weights.sides)),
        linear{place.offset, batch.nodes, grid.inverse_cell()} {}
};

// The same with the weights of APIC.
template <class Shape, int Dim, class Real>
struct AffineWeights : MomentumWeights<Shape, Dim, Real> {};
template <class Shape, int Dim, class Real>
struct BatchWeights<AffineWeights<Shape, Dim, Real>, Dim, Real>
    : BatchWeights<MomentumWeights<Shape, Dim, Real>, Dim, Real> {
  using Base = BatchWeights<MomentumWeights<Shape, Dim, Real>, Dim, Real>;
  AffineBatch<Dim, Real> affine;

  THAWSLIDE_ALWAYS_INLINE BatchWeights(const AffineWeights<Shape, Dim, Real>& weights,
                                       const SparseGrid<Dim, Real>& grid, const Particles<Dim, Real>& particles,
                                       const TileBatch<Dim, Real>& batch)
      : Base(weights, grid, particles, batch),
        affine(make_affine<Shape>(grid, this->momentum, place_of(grid, particles, batch), weights.sides)) {}
  template <class Functions>
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE const auto& of() const {
    if constexpr (std::is_same_v<Functions, AffineFunctions>) {
      return affine.nodes;
    } else {
      return Base::template of<Functions>();
    }
  }
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE const auto& second_moment() const { return affine.moment; }
};

// What a batch sees of the records about it.
template <class Weights, class Patches>
struct SeenByBatch {
  const Weights& weights;
  const Patches& patches;

  // `Count` numbers of a record from `first` on: their values at the particles' places and their gradients.
  template <class Name, std::size_t Count>
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE auto read(std::size_t first = 0) const {
    return read_nodes<Count>(weights.template of<typename Name::Functions>(), patches.template of<Name>(), first);
  }
  // The values of all numbers of a record, without their gradients.
  template <class Name>
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE auto values() const {
    return read_values(weights.template of<typename Name::Functions>(), patches.template of<Name>());
  }
};

// What particles add to a record, and a tile's sums of it. A record that has an owner is another way to add to the
// owner's: with other weights, to one of its registers. It takes a pass of its own after the owner's, since the order
// in which the two would add in one pass depends on where batches begin.
template <class Name>
concept OfAnOwner = requires {
  typename Name::Owner;
};
template <class Name, int Dim, class Real>
struct Adding {
  static constexpr std::size_t carried = components_of<Name, Dim>, first = 0;
  static constexpr bool has_flux = Name::flux != no_flux;
  using Sums = std::conditional_t<std::is_same_v<typename Name::Functions, LinearFunctions>,
                                  LinearCellSums<has_flux, first, carried, Dim, Real, components_of<Name, Dim>>,
                                  CellSums<Name::flux, first, carried, Dim, Real, components_of<Name, Dim>>>;
};
template <OfAnOwner Name, int Dim, class Real>
struct Adding<Name, Dim, Real> {
  static constexpr std::size_t carried = Dim, first = Name::template first<Dim>;
  static constexpr bool has_flux = true;
  using Sums = CellSums<0, first, carried, Dim, Real, components_of<Name, Dim>>;
};
template <class List>
inline constexpr bool has_owner = false;
template <class... Names>
inline constexpr bool has_owner<RecordList<Names...>> = (OfAnOwner<Names> || ...);
template <class List>
inline constexpr std::size_t count_of = 0;
template <class... Names>
inline constexpr std::size_t count_of<RecordList<Names...>> = sizeof...(Names);
template <class Name, int Dim, class Real>
using SumsOf = typename Adding<Name, Dim, Real>::Sums;

// A tile at work: what its particles read and add to.
template <class Reads, class Adds, int Dim, class Real>
class TileWork;
template <class... Reads, class... Adds, int Dim, class Real>
class TileWork<RecordList<Reads...>, RecordList<Adds...>, Dim, Real> {
  using Patches = ByName<Named<Reads, PatchOf<Reads, Dim, Real>>...>;

 public:
  template <class Records>
  TileWork([[maybe_unused]] const SparseGrid<Dim, Real>& grid, [[maybe_unused]] std::size_t tile,
           [[maybe_unused]] Records& records)
      : sums_{{SumsOf<Adds, Dim, Real>(cleared<Adds>(records, grid, tile))}...} {
    (load_patch(grid, tile, records.template of<Reads>(), patches_.template of<Reads>()), ...);
  }

  template <class Weights>
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE SeenByBatch<Weights, Patches> seen(const Weights& weights) const {
    return {weights, patches_};
  }

  using Added = ByName<Named<Adds, Contribution<Dim, Real, Adding<Adds, Dim, Real>::carried>>...>;
  template <class Weights>
  THAWSLIDE_ALWAYS_INLINE void add([[maybe_unused]] const Weights& weights, [[maybe_unused]] std::size_t count,
                                   [[maybe_unused]] const Added& added) {
    (sums_.template of<Adds>().add(weights.template of<typename Adds::Functions>(), count, added.template of<Adds>()),
     ...);
  }

 private:
  template <class Name, class Records>
  static auto& cleared(Records& records, const SparseGrid<Dim, Real>& grid, std::size_t tile) {
    auto& patch = records.template of<Name>().patches(grid.tiles().size())[tile];
    if constexpr (!OfAnOwner<Name>) {
      patch.clear();
    }
    return patch;
  }

  Patches patches_;
  ByName<Named<Adds, SumsOf<Adds, Dim, Real>>...> sums_;
};

// What kernels sum over particles, kernel by kernel.
template <class... Kernels>
struct Accounts : std::tuple<typename Kernels::Account...> {
  Accounts& operator+=(const Accounts& part) {
    [&]<std::size_t... K>(std::index_sequence<K...>) { ((std::get<K>(*this) += std::get<K>(part)), ...); }
    (std::index_sequence_for<Kernels...>());
    return *this;
  }
};

// The kernel for one tile, where that differs from tile to tile.
template <class Kernel>
THAWSLIDE_ALWAYS_INLINE decltype(auto) in_tile(const Kernel& kernel, std::size_t tile) {
  if constexpr (requires { kernel.in_tile(tile); }) {
    return kernel.in_tile(tile);
  } else {
    return (kernel);
  }
}

inline constexpr auto every_tile = [](std::size_t /*tile*/) { return true; };

// Room for the patches of records.
template <class... Names, class Records>
void take_patches(RecordList<Names...> /*names*/, [[maybe_unused]] std::size_t tiles,
                  [[maybe_unused]] Records& records) {
  (static_cast<void>(records.template of<Names>().patches(tiles)), ...);
}

// Runs kernels over the particles of the tiles that takes_tile(t) names, one after the other for each batch; what they
// add is in the patches then, to be summed by a node_pass. Records: of Nodes.
template <class Weights, int Dim, class Real, class Records, class TakesTile, class... Kernels>
Accounts<Kernels...> particle_pass(const SparseGrid<Dim, Real>& grid, const Weights& weights,
                                   Particles<Dim, Real>& particles, Records& records, const TakesTile& takes_tile,
                                   const Kernels&... kernels) {
  using Reads = AllOf<typename Kernels::Reads...>;
  using Adds = AllOf<typename Kernels::Adds...>;
  static_assert(!(has_owner<Adds> && count_of<Adds> > 1), "a record with an owner takes a pass of its own");
  static_assert(are_disjoint<Reads, Adds>, "no record is read in the pass that adds to it: it has no sums yet");
  take_patches(Adds{}, grid.tiles().size(), records);
  return parallel_sum<Accounts<Kernels...>>(grid.tiles().size(), [&](std::size_t t, Accounts<Kernels...>& accounts) {
    if (!takes_tile(t)) {
      return;
    }
    TileWork<Reads, Adds, Dim, Real> work(grid, t, records);
    const auto run = [&]<std::size_t... K>(std::index_sequence<K...> /*kernels*/, const auto&... of_tile) {
      for (const TileBatch<Dim, Real>& batch : grid.batches(t)) {
        const BatchWeights<Weights, Dim, Real> of_batch(weights, grid, particles, batch);
        typename TileWork<Reads, Adds, Dim, Real>::Added added;
        (of_tile(particles, batch, work.seen(of_batch), added, std::get<K>(accounts)), ...);
        work.add(of_batch, batch.count, added);
      }
    };
    run(std::index_sequence_for<Kernels...>(), in_tile(kernels, t)...);
  });
}

}  // namespace thawslide::mpm
