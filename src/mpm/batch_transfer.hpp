// Transfers of a batch of particles: their nodes and weights lane by lane, what they read of the nodes, what they add.
#pragma once

#include <cstring>

#include "mpm/transfer.hpp"

namespace thawslide::mpm {

// The nodes that the particles of a batch see: the places of the lowest ones in their tile's patch.
template <class Real>
struct BatchNodes {
  std::array<std::int64_t, lane_count<Real>> first;  // by lane
  bool shared;                                       // all lanes see the same nodes
};

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
                                                       const Batch<Real>& batch) {
  BatchPlace<Dim, Real> place;
  for (int a = 0; a < Dim; ++a) {
    const Lanes<Real> in_cells = particles.position.load(batch, a) * grid.inverse_cell();
    place.node[a] = floor(in_cells + Real(0.5));
    place.offset[a] = in_cells - place.node[a];
  }
  return place;
}

// The nodes that lanes see, from the lowest one's numbers along the axes.
template <int Dim, class Real>
THAWSLIDE_ALWAYS_INLINE BatchNodes<Real> nodes_from(std::uint64_t tile_key, const Vector<Lanes<Real>, Dim>& lowest) {
  using T = Tile<Dim>;
  const typename T::Index tile = T::index(tile_key);
  Lanes<Real> place = Real(0);
  for (int a = Dim - 1; a >= 0; --a) {
    const auto before = static_cast<Real>(tile[static_cast<std::size_t>(a)] * T::edge - 1);
    place = place * Real(T::patch_edge) + (lowest[a] - before);
  }
  BatchNodes<Real> nodes;
  nodes.shared = true;
  for (std::size_t lane = 0; lane < lane_count<Real>; ++lane) {
    nodes.first[lane] = static_cast<std::int64_t>(place[lane]);
    nodes.shared = nodes.shared && nodes.first[lane] == nodes.first[0];
  }
  return nodes;
}

// Lanes at a side of the domain that prescribes velocity.
template <int Dim, class Real>
THAWSLIDE_ALWAYS_INLINE LaneMask<Real> at_side(const HeldSides<Dim>& sides, int axis, Lanes<Real> node) {
  const auto a = static_cast<std::size_t>(axis);
  return (node == static_cast<Real>(sides.lower[a])) | (node == static_cast<Real>(sides.upper[a]));
}

// For shape functions Shape (Ugimp, Linear, Quadratic); half: half sizes of the particles in cells.
template <class Shape, int Dim, class Real>
THAWSLIDE_ALWAYS_INLINE BatchStencil<Dim, Real> make_stencil(const SparseGrid<Dim, Real>& grid, std::uint64_t tile_key,
                                                             const BatchPlace<Dim, Real>& place, Lanes<Real> half,
                                                             const HeldSides<Dim>& sides) {
  const Vector<Lanes<Real>, Dim> lowest = place.node - Vector<Lanes<Real>, Dim>::Constant(Real(1));
  return {nodes_from<Dim, Real>(tile_key, lowest), for_axes<Dim>([&](int a) THAWSLIDE_INLINE_LAMBDA {
            return Shape::weights(place.offset[a], half, at_side(sides, a, place.node[a]), grid.inverse_cell());
          })};
}

// The corners of the particles' cells with their linear hats.
template <int Dim, class Real>
THAWSLIDE_ALWAYS_INLINE BatchStencil<Dim, Real, 2> hat_stencil(const SparseGrid<Dim, Real>& grid,
                                                               std::uint64_t tile_key,
                                                               const Particles<Dim, Real>& particles,
                                                               const Batch<Real>& batch) {
  const BatchPlace<Dim, Real> place = place_of(grid, particles, batch);
  const Lanes<Real> slope = grid.inverse_cell();
  Vector<Lanes<Real>, Dim> lowest, along;
  for (int a = 0; a < Dim; ++a) {
    const Lanes<Real> from_node = place.offset[a];  // within [-1/2, 1/2]
    const Lanes<Real> left = select(from_node < Real(0), Lanes<Real>(Real(1)), Lanes<Real>(Real(0)));
    along[a] = from_node + left;
    lowest[a] = place.node[a] - left;
  }
  return {nodes_from<Dim, Real>(tile_key, lowest), for_axes<Dim>([&](int a) THAWSLIDE_INLINE_LAMBDA {
            return AxisWeights<Lanes<Real>, 2>{{Real(1) - along[a], along[a]}, {-slope, slope}};
          })};
}

// The same nodes and weights for APIC (AffineStencil).
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
  const std::array<std::int64_t, lane_count<Real>>& first;

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

// What a batch adds to the records about it: weight * value, and in the first components also gradient . flux.
template <int Dim, class Real, std::size_t Components>
struct Contribution {
  std::array<Lanes<Real>, record_size<Real>(Components)> value;
  std::array<std::array<Lanes<Real>, lane_count<Real>>, Dim> flux;  // by axis

  Contribution() {
    value.fill(Real(0));
    for (auto& along : flux) {
      along.fill(Real(0));
    }
  }
};

// Weights and gradients of every node, in the order of their places.
template <int Dim, class Real, std::size_t Width>
struct NodeWeights {
  static constexpr std::size_t nodes = static_cast<std::size_t>(power(static_cast<int>(Width), Dim));
  std::array<std::size_t, nodes> offset;
  std::array<Lanes<Real>, nodes> weight;
  std::array<std::array<Lanes<Real>, nodes>, Dim> gradient;
};

template <int Dim, class Real, std::size_t Width>
THAWSLIDE_ALWAYS_INLINE NodeWeights<Dim, Real, Width> node_weights(const BatchStencil<Dim, Real, Width>& stencil) {
  NodeWeights<Dim, Real, Width> weights;
  std::size_t k = 0;
  const auto keep = [&](std::size_t place, Lanes<Real> weight, const Vector<Lanes<Real>, Dim>& gradient) {
    weights.offset[k] = place;
    weights.weight[k] = weight;
    for (std::size_t a = 0; a < Dim; ++a) {
      weights.gradient[a][k] = gradient[static_cast<int>(a)];
    }
    ++k;
  };
  for_each_node<Dim>(stencil.axis, 0, keep);
  return weights;
}

// What one lane adds to one register of a record: g components on. HasFlux: contribution.flux is not zero.
template <bool HasFlux, int Dim, class Real, std::size_t Width, std::size_t Carried>
THAWSLIDE_ALWAYS_INLINE void add_lane(const NodeWeights<Dim, Real, Width>& nodes, std::size_t node, std::size_t lane,
                                      const Contribution<Dim, Real, Carried>& rows, std::size_t group,
                                      Lanes<Real>& sum) {
  sum += Lanes<Real>(nodes.weight[node][lane]) * rows.value[group * lane_count<Real> + lane];
  for (std::size_t a = 0; HasFlux && group == 0 && a < Dim; ++a) {
    sum += Lanes<Real>(nodes.gradient[a][node][lane]) * rows.flux[a][lane];
  }
}

// Adds to every node particle after particle, a register of components at a time. Particles that see the same nodes go
// to a node together, which is then read and written once.
template <bool HasFlux, int Dim, class Real, std::size_t Width, int Components, std::size_t Carried>
THAWSLIDE_ALWAYS_INLINE void add_to_nodes(const BatchStencil<Dim, Real, Width>& stencil, std::size_t count,
                                          Contribution<Dim, Real, Carried>& rows, Patch<Dim, Real, Components>& patch) {
  constexpr std::size_t lanes = lane_count<Real>;
  constexpr std::size_t groups = record_size<Real>(static_cast<int>(Carried)) / lanes;
  static_assert(record_size<Real>(static_cast<int>(Carried)) == record_size<Real>(Components));
  unrolled<groups>([&](auto g) THAWSLIDE_INLINE_LAMBDA { transpose(&rows.value[g * lanes]); });
  unrolled<HasFlux ? Dim : 0>([&](auto a) THAWSLIDE_INLINE_LAMBDA { transpose(&rows.flux[a][0]); });
  const NodeWeights<Dim, Real, Width> nodes = node_weights(stencil);
  if (stencil.nodes.shared && count == lanes) {
    auto* records = &patch.records[static_cast<std::size_t>(stencil.nodes.first[0])];
    for (std::size_t k = 0; k < nodes.weight.size(); ++k) {
      Real* record = records[nodes.offset[k]].data();
      unrolled<groups>([&](auto g) THAWSLIDE_INLINE_LAMBDA {
        Lanes<Real> sum = Lanes<Real>::load(record + g * lanes);
        unrolled<lanes>([&](auto lane) THAWSLIDE_INLINE_LAMBDA { add_lane<HasFlux>(nodes, k, lane, rows, g, sum); });
        sum.store(record + g * lanes);
      });
    }
    return;
  }
  for (std::size_t lane = 0; lane < count; ++lane) {
    auto* records = &patch.records[static_cast<std::size_t>(stencil.nodes.first[lane])];
    for (std::size_t k = 0; k < nodes.weight.size(); ++k) {
      Real* record = records[nodes.offset[k]].data();
      for (std::size_t g = 0; g < groups; ++g) {
        Lanes<Real> sum = Lanes<Real>::load(record + g * lanes);
        add_lane<HasFlux>(nodes, k, lane, rows, g, sum);
        sum.store(record + g * lanes);
      }
    }
  }
}

}  // namespace thawslide::mpm
