// Transfers of a batch of particles: their nodes and weights lane by lane, what they read of the nodes, what they add.
#pragma once

#include <cstring>

#include "mpm/transfer.hpp"

namespace thawslide::mpm {

// The nodes and their weights. Made in one piece: g++ copies an array of registers by a call.
template <int Dim, class Real, std::size_t Width = 3>
struct BatchStencil {
  BatchNodes<Real> nodes;
  std::array<AxisWeights<Lanes<Real>, Width>, Dim> axis;
};

// An array of what make(axis) gives.
template <int Dim, class Make>
THAWSLIDE_ALWAYS_INLINE auto for_axes(const Make& make) {
  using Item = decltype(make(0));
  if constexpr (Dim == 2) {
    return std::array<Item, 2>{make(0), make(1)};
  } else {
    return std::array<Item, 3>{make(0), make(1), make(2)};
  }
}

// Where the particles of a batch stand: their nearest nodes and their offsets from them, in cells.
template <int Dim, class Real>
struct BatchPlace {
  Vector<Lanes<Real>, Dim> node, offset;
};

template <int Dim, class Real>
THAWSLIDE_ALWAYS_INLINE BatchPlace<Dim, Real> place_of(const SparseGrid<Dim, Real>& grid,
                                                       const Particles<Dim, Real>& particles,
                                                       const TileBatch<Dim, Real>& batch) {
  BatchPlace<Dim, Real> place;
  for (int a = 0; a < Dim; ++a) {
    place.node[a] = Lanes<Real>::load_whole(batch.nearest[static_cast<std::size_t>(a)].data());
    place.offset[a] = particles.position.load(batch, a) * grid.inverse_cell() - place.node[a];
  }
  return place;
}

// Lanes at a side of the domain that prescribes velocity.
template <int Dim, class Real>
THAWSLIDE_ALWAYS_INLINE LaneMask<Real> at_side(const HeldSides<Dim>& sides, int axis, Lanes<Real> node) {
  const auto a = static_cast<std::size_t>(axis);
  return (node == static_cast<Real>(sides.lower[a])) | (node == static_cast<Real>(sides.upper[a]));
}

// For shape functions Shape (Ugimp, Linear, Quadratic); half: half sizes of the particles in cells.
template <class Shape, int Dim, class Real>
THAWSLIDE_ALWAYS_INLINE BatchStencil<Dim, Real> make_stencil(const SparseGrid<Dim, Real>& grid,
                                                             const TileBatch<Dim, Real>& batch,
                                                             const BatchPlace<Dim, Real>& place, Lanes<Real> half,
                                                             const HeldSides<Dim>& sides) {
  return {batch.nodes, for_axes<Dim>([&](int a) THAWSLIDE_INLINE_LAMBDA {
            return Shape::weights(place.offset[a], half, at_side(sides, a, place.node[a]), grid.inverse_cell());
          })};
}

// The corners of the particles' cells with their linear hats.
template <int Dim, class Real>
THAWSLIDE_ALWAYS_INLINE BatchStencil<Dim, Real, 2> hat_stencil(const SparseGrid<Dim, Real>& grid,
                                                               const Particles<Dim, Real>& particles,
                                                               const TileBatch<Dim, Real>& batch) {
  const Lanes<Real> slope = grid.inverse_cell();
  return {batch.hats, for_axes<Dim>([&](int a) THAWSLIDE_INLINE_LAMBDA {
            const Lanes<Real> in_cells = particles.position.load(batch, a) * grid.inverse_cell();
            const Lanes<Real> along = in_cells - floor(in_cells);
            return AxisWeights<Lanes<Real>, 2>{{Real(1) - along, along}, {-slope, slope}};
          })};
}

// The same nodes and weights for APIC: in place of the gradient G_i stands S_i (x_i - x_p)/D, with which node
// velocities make the affine velocity C. moment: the second moments D [m2] along each axis.
template <int Dim, class Real>
struct AffineBatch {
  BatchStencil<Dim, Real> nodes;
  Vector<Lanes<Real>, Dim> moment;
};

template <class Shape, int Dim, class Real>
THAWSLIDE_ALWAYS_INLINE AffineBatch<Dim, Real> make_affine(const SparseGrid<Dim, Real>& grid,
                                                           const BatchStencil<Dim, Real>& stencil,
                                                           const BatchPlace<Dim, Real>& place,
                                                           const HeldSides<Dim>& sides) {
  const auto axis = [&](int a) THAWSLIDE_INLINE_LAMBDA {
    return Shape::affine(stencil.axis[static_cast<std::size_t>(a)], place.offset[a], at_side(sides, a, place.node[a]),
                         grid.inverse_cell());
  };
  AffineBatch<Dim, Real> affine{{stencil.nodes, for_axes<Dim>(axis)}, {}};
  for (int a = 0; a < Dim; ++a) {
    affine.moment[a] =
        second_moment(stencil.axis[static_cast<std::size_t>(a)], place.offset[a]) * (grid.cell() * grid.cell());
  }
  return affine;
}

// Fetch(place, component) for read_nodes: one number for all lanes where they see the same nodes, else one by one.
template <int Dim, class Real, int Components>
struct SharedNodes {
  const Patch<Dim, Real, Components>& patch;
  std::size_t first;

  THAWSLIDE_ALWAYS_INLINE Lanes<Real> operator()(std::size_t offset, std::size_t component) const {
    return patch.records[first + offset][component];
  }
};
template <int Dim, class Real, int Components>
struct OwnNodes {
  const Patch<Dim, Real, Components>& patch;
  const std::array<std::int32_t, lane_count<Real>>& first;

  THAWSLIDE_ALWAYS_INLINE Lanes<Real> operator()(std::size_t offset, std::size_t component) const {
    return Lanes<Real>::of(
        [&](std::size_t lane) { return patch.records[static_cast<std::size_t>(first[lane]) + offset][component]; });
  }
};

// What the particles read of `Count` numbers of the records about them.
template <std::size_t Count, int Dim, class Real, std::size_t Width, int Components>
THAWSLIDE_ALWAYS_INLINE Reading<Dim, Lanes<Real>, Count> read_nodes(const BatchStencil<Dim, Real, Width>& stencil,
                                                                    const Patch<Dim, Real, Components>& patch,
                                                                    std::size_t first_component = 0) {
  if (stencil.nodes.shared) {
    const SharedNodes<Dim, Real, Components> nodes{patch, static_cast<std::size_t>(stencil.nodes.first[0])};
    return read_along_axes<Count>(stencil.axis, nodes, first_component);
  }
  const OwnNodes<Dim, Real, Components> nodes{patch, stencil.nodes.first};
  return read_along_axes<Count>(stencil.axis, nodes, first_component);
}

// One particle's weights, each in all lanes.
template <int Dim, class Real, std::size_t Width>
struct SpreadWeights {
  Lanes<Real> weight[Dim][Width], slope[Dim][Width];

  THAWSLIDE_ALWAYS_INLINE SpreadWeights(const BatchStencil<Dim, Real, Width>& stencil, std::size_t lane) {
    unrolled<Dim * Width>([&](auto k) THAWSLIDE_INLINE_LAMBDA {
      weight[k / Width][k % Width] = stencil.axis[k / Width].weight[k % Width][lane];
      slope[k / Width][k % Width] = stencil.axis[k / Width].slope[k % Width][lane];
    });
  }
};

// What one particle reads of one register of every record about it.
template <int Axis, int Dim, class Real, std::size_t Width>
THAWSLIDE_ALWAYS_INLINE Lanes<Real> sum_along_axes(const SpreadWeights<Dim, Real, Width>& spread,
                                                   std::size_t record_size, const Real* records) {
  constexpr auto stride = static_cast<std::size_t>(power(Tile<Dim>::patch_edge, Axis));
  Lanes<Real> sum = Real(0);
  unrolled<Width>([&](auto k) THAWSLIDE_INLINE_LAMBDA {
    const Real* place = records + k * stride * record_size;
    if constexpr (Axis == 0) {
      sum += spread.weight[0][k] * Lanes<Real>::load(place);
    } else {
      sum += spread.weight[Axis][k] * sum_along_axes<Axis - 1>(spread, record_size, place);
    }
  });
  return sum;
}

// The values, without gradients, of all components of the records about a batch: particle by particle, a register of
// components at a time, wherever their nodes are.
template <int Dim, class Real, std::size_t Width, int Components>
THAWSLIDE_ALWAYS_INLINE std::array<Lanes<Real>, record_size<Real>(Components)> read_values(
    const BatchStencil<Dim, Real, Width>& stencil, const Patch<Dim, Real, Components>& patch) {
  constexpr std::size_t lanes = lane_count<Real>, size = record_size<Real>(Components);
  alignas(sizeof(Lanes<Real>)) Real of_lane[size / lanes][lanes * lanes];
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const SpreadWeights<Dim, Real, Width> spread(stencil, lane);
    const Real* records = patch.records[static_cast<std::size_t>(stencil.nodes.first[lane])].data();
    unrolled<size / lanes>([&](auto g) THAWSLIDE_INLINE_LAMBDA {
      sum_along_axes<Dim - 1>(spread, size, records + g * lanes).store(&of_lane[g][lane * lanes]);
    });
  }
  std::array<Lanes<Real>, size> values;
  unrolled<size / lanes>([&](auto g) THAWSLIDE_INLINE_LAMBDA {
    unrolled<lanes>([&](auto lane) THAWSLIDE_INLINE_LAMBDA {
      values[g * lanes + lane] = Lanes<Real>::load(&of_lane[g][lane * lanes]);
    });
    transpose(&values[g * lanes]);
  });
  return values;
}

// What a batch adds to the records about it: weight * value, and in the components of one register also
// gradient . flux.
template <int Dim, class Real, std::size_t Components>
struct Contribution {
  static constexpr std::size_t lanes = lane_count<Real>;
  static constexpr std::size_t groups = record_size<Real>(static_cast<int>(Components)) / lanes;  // of registers

  Lanes<Real> value[groups * lanes];
  Lanes<Real> flux[Dim][lanes];  // by axis

  Contribution() {
    unrolled<groups * lanes>([&](auto c) THAWSLIDE_INLINE_LAMBDA { value[c] = Real(0); });
    unrolled<Dim * lanes>([&](auto c) THAWSLIDE_INLINE_LAMBDA { flux[c / lanes][c % lanes] = Real(0); });
  }

  // From a row a component to a row a particle: row k of a register's components becomes what lane k adds to them.
  template <bool HasFlux>
  THAWSLIDE_ALWAYS_INLINE void by_particle() {
    unrolled<groups>([&](auto g) THAWSLIDE_INLINE_LAMBDA { transpose(&value[g * lanes]); });
    unrolled<HasFlux ? Dim : 0>([&](auto a) THAWSLIDE_INLINE_LAMBDA { transpose(flux[a]); });
  }
};

// What a particle adds to one register of every record about it, axis by axis, the last one first: fewer products than
// node by node. along: flux along this axis and the ones before it.
template <int Axis, bool HasFlux, int Dim, class Real, std::size_t Width>
THAWSLIDE_ALWAYS_INLINE void add_along_axes(const SpreadWeights<Dim, Real, Width>& spread, Lanes<Real> value,
                                            Lanes<Real> along_0, Lanes<Real> along_1, Lanes<Real> along_2,
                                            std::size_t record_size, Real* records) {
  constexpr auto stride = static_cast<std::size_t>(power(Tile<Dim>::patch_edge, Axis));
  const Lanes<Real> along = Axis == 0 ? along_0 : Axis == 1 ? along_1 : along_2;
  unrolled<Width>([&](auto k) THAWSLIDE_INLINE_LAMBDA {
    const Lanes<Real>& weight = spread.weight[Axis][k];
    Real* place = records + k * stride * record_size;
    if constexpr (Axis == 0) {
      Lanes<Real> sum = Lanes<Real>::load(place) + weight * value;
      if constexpr (HasFlux) {
        sum += spread.slope[0][k] * along;
      }
      sum.store(place);
    } else {
      Lanes<Real> part = weight * value;
      if constexpr (HasFlux) {
        part += spread.slope[Axis][k] * along;
      }
      add_along_axes<Axis - 1, HasFlux>(spread, part, weight * along_0, weight * along_1, along_2, record_size, place);
    }
  });
}

constexpr int no_flux = -1;

// Adds to every node particle after particle, a register of components at a time, from component `First` on.
// FluxGroup: number of the register, from there, to which the flux adds.
template <int FluxGroup, std::size_t First = 0, int Dim, class Real, std::size_t Width, int Components,
          std::size_t Carried>
THAWSLIDE_ALWAYS_INLINE void add_to_nodes(const BatchStencil<Dim, Real, Width>& stencil, std::size_t count,
                                          Contribution<Dim, Real, Carried>& rows, Patch<Dim, Real, Components>& patch) {
  constexpr std::size_t lanes = lane_count<Real>;
  constexpr std::size_t size = record_size<Real>(Components);
  constexpr std::size_t groups = Contribution<Dim, Real, Carried>::groups;
  static_assert(First % lanes == 0 && First + groups * lanes <= size);
  rows.template by_particle<FluxGroup != no_flux>();
  for (std::size_t lane = 0; lane < count; ++lane) {
    const SpreadWeights<Dim, Real, Width> spread(stencil, lane);
    Real* records = patch.records[static_cast<std::size_t>(stencil.nodes.first[lane])].data() + First;
    unrolled<groups>([&](auto g) THAWSLIDE_INLINE_LAMBDA {
      constexpr bool has_flux = static_cast<int>(g()) == FluxGroup;
      add_along_axes<Dim - 1, has_flux>(spread, rows.value[g * lanes + lane], rows.flux[0][lane], rows.flux[1][lane],
                                        rows.flux[Dim - 1][lane], size, records + g * lanes);
    });
  }
}

}  // namespace thawslide::mpm
