// Transfers of a particle batch: nodes and weights by SIMD lane, gather from nodes and contributions to nodes.
#pragma once

#include <cstring>
#include <limits>

#include "mpm/transfer.hpp"

namespace thawslide::mpm {

// Nodes and their weights. Constructed as an aggregate, because g++ copies an array of registers by a call.
template <int Dim, std::size_t Width = 3>
struct BatchStencil {
  BatchNodes nodes;
  std::array<AxisWeights<Simd<double>, Width>, Dim> axis;
};

// Array of the results of make(axis).
template <int Dim, class Make>
THAWSLIDE_ALWAYS_INLINE auto for_axes(const Make& make) {
  using Item = decltype(make(0));
  if constexpr (Dim == 2) {
    return std::array<Item, 2>{make(0), make(1)};
  } else {
    return std::array<Item, 3>{make(0), make(1), make(2)};
  }
}

// Positions of the particles of a batch: nearest nodes, and offsets from them in cells.
template <int Dim>
struct BatchGridPosition {
  Vector<Simd<double>, Dim> node, offset;
};

template <int Dim>
THAWSLIDE_ALWAYS_INLINE BatchGridPosition<Dim> grid_position(const SparseGrid<Dim>& grid,
                                                             const Particles<Dim>& particles,
                                                             const TileBatch<Dim>& batch) {
  BatchGridPosition<Dim> at;
  for (int a = 0; a < Dim; ++a) {
    at.node[a] = Simd<double>::load_whole(batch.nearest[static_cast<std::size_t>(a)].data());
    at.offset[a] = grid.mapping().template coordinate<Dim>(particles, batch, a) * grid.inverse_cell() - at.node[a];
  }
  return at;
}

// Lanes at a side of the domain that prescribes velocity.
template <int Dim>
THAWSLIDE_ALWAYS_INLINE SimdMask<double> at_side(const PrescribedSides<Dim>& sides, int axis, Simd<double> node) {
  const auto a = static_cast<std::size_t>(axis);
  return (node == static_cast<double>(sides.lower[a])) | (node == static_cast<double>(sides.upper[a]));
}

// Stencil for a shape function, which is selected by batch: a pass is then compiled once. size: of the particles, in
// cells.
template <int Dim>
THAWSLIDE_ALWAYS_INLINE BatchStencil<Dim> make_stencil(ShapeFunction shape, const SparseGrid<Dim>& grid,
                                                       const TileBatch<Dim>& batch, const BatchGridPosition<Dim>& at,
                                                       const HalfSize<Simd<double>>& size,
                                                       const PrescribedSides<Dim>& sides) {
  const auto of_axes = [&](auto functions) THAWSLIDE_INLINE_LAMBDA {
    return for_axes<Dim>([&](int a) THAWSLIDE_INLINE_LAMBDA {
      return functions.weights(at.offset[a], size, at_side(sides, a, at.node[a]), grid.inverse_cell());
    });
  };
  return {batch.nodes, shape == ShapeFunction::ugimp ? of_axes(Ugimp{}) : of_axes(Quadratic{})};
}

// Corners of the grid cells that particles lie in, as places in the patch and among the 3^Dim nodes around the nearest
// node.
template <int Dim>
struct CornerStencil : BatchStencil<Dim, 2> {
  std::array<std::int32_t, simd_width<double>> first_in_cell;  // of the lowest corner, by lane
};

// Linear shape functions of a batch. Scatter uses the corners of the particles' cells. Gather uses all nodes around the
// nearest ones, because neighbours share these more often than corners.
template <int Dim>
struct LinearStencil {
  Vector<Simd<double>, Dim> offset;  // from the nearest node, in cells
  const BatchNodes& nodes;
  double inverse_cell;

  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE CornerStencil<Dim> corners() const {
    const Simd<double> zero = 0.0, one = 1.0, slope = inverse_cell;
    Simd<double> index = Simd<double>::load_whole(nodes.first.data()), in_cell = zero;
    for (int a = 0; a < Dim; ++a) {
      const auto right = offset[a] >= zero;
      index += select(right, Simd<double>(double(power(Tile<Dim>::patch_edge, a))), zero);
      in_cell += select(right, Simd<double>(double(power(3, a))), zero);
    }
    BatchNodes corner_nodes;
    index.store_whole(corner_nodes.first.data());
    corner_nodes.runs = BatchNodes::irregular;
    CornerStencil<Dim> corners{{corner_nodes, for_axes<Dim>([&](int a) THAWSLIDE_INLINE_LAMBDA {
                                  const Simd<double> along = select(offset[a] >= zero, offset[a], one + offset[a]);
                                  const Simd<double> back = select(offset[a] >= zero, one - offset[a], -offset[a]);
                                  return AxisWeights<Simd<double>, 2>{{back, along}, {-slope, slope}};
                                })},
                               {}};
    in_cell.store_whole(corners.first_in_cell.data());
    return corners;
  }
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE BatchStencil<Dim> about() const {
    return {nodes,
            for_axes<Dim>([&](int a) THAWSLIDE_INLINE_LAMBDA { return linear_weights(offset[a], inverse_cell); })};
  }
};

template <int Dim>
THAWSLIDE_ALWAYS_INLINE LinearStencil<Dim> linear_stencil(const SparseGrid<Dim>& grid, const Particles<Dim>& particles,
                                                          const TileBatch<Dim>& batch) {
  return {grid_position(grid, particles, batch).offset, batch.nodes, grid.inverse_cell()};
}

// Same nodes and weights for APIC: S_i (x_i - x_p)/D replaces the gradient G_i, so that node velocities give the affine
// velocity C. moment: second moments D [m2] along each axis.
template <int Dim>
struct AffineBatch {
  BatchStencil<Dim> nodes;
  Vector<Simd<double>, Dim> moment;
};

template <int Dim>
THAWSLIDE_ALWAYS_INLINE AffineBatch<Dim> make_affine(ShapeFunction shape, const SparseGrid<Dim>& grid,
                                                     const BatchStencil<Dim>& stencil, const BatchGridPosition<Dim>& at,
                                                     const PrescribedSides<Dim>& sides) {
  const auto of_axes = [&](auto functions) THAWSLIDE_INLINE_LAMBDA {
    return for_axes<Dim>([&](int a) THAWSLIDE_INLINE_LAMBDA {
      return functions.affine(stencil.axis[static_cast<std::size_t>(a)], at.offset[a], at_side(sides, a, at.node[a]),
                              grid.inverse_cell());
    });
  };
  AffineBatch<Dim> affine{{stencil.nodes, shape == ShapeFunction::ugimp ? of_axes(Ugimp{}) : of_axes(Quadratic{})}, {}};
  for (int a = 0; a < Dim; ++a) {
    affine.moment[a] =
        second_moment(stencil.axis[static_cast<std::size_t>(a)], at.offset[a]) * (grid.cell() * grid.cell());
  }
  return affine;
}

// Fetch(place, component) for read_nodes: one number for all lanes if they have the same nodes, two for two runs of
// such lanes, otherwise a gather.
template <int Dim, int Components>
struct SharedNodes {
  const Patch<Dim, Components>& patch;
  std::size_t first;

  THAWSLIDE_ALWAYS_INLINE Simd<double> operator()(std::size_t offset, std::size_t component) const {
    return patch.records[first + offset][component];
  }
};
template <int Dim, int Components>
struct NodesOfTwoRuns {
  const Patch<Dim, Components>& patch;
  std::size_t first, second;
  SimdMask<double> in_first;

  THAWSLIDE_ALWAYS_INLINE Simd<double> operator()(std::size_t offset, std::size_t component) const {
    return select(in_first, Simd<double>(patch.records[first + offset][component]),
                  Simd<double>(patch.records[second + offset][component]));
  }
};
template <int Dim, int Components>
struct OwnNodes {
  const Patch<Dim, Components>& patch;
  typename Simd<double>::Whole first;  // index of the first number, by lane

  OwnNodes(const Patch<Dim, Components>& from, const BatchNodes& nodes)
      : patch(from),
        first(whole_lanes<double>(nodes.first.data()) * static_cast<std::int32_t>(record_size(Components))) {}

  THAWSLIDE_ALWAYS_INLINE Simd<double> operator()(std::size_t offset, std::size_t component) const {
    return Simd<double>::gather(&patch.records[offset][component], first);
  }
};

// Calls read(fetch) with the fetch that matches the nodes of a batch.
template <int Dim, int Components, class Read>
THAWSLIDE_ALWAYS_INLINE auto with_fetch(const BatchNodes& nodes, const Patch<Dim, Components>& patch,
                                        const Read& read) {
  const auto first = static_cast<std::size_t>(nodes.first[0]);
  if (nodes.runs == 1) {
    return read(SharedNodes<Dim, Components>{patch, first});
  }
  if (nodes.runs == 2) {
    const auto second = static_cast<std::size_t>(nodes.first[simd_width<double> - 1]);
    return read(NodesOfTwoRuns<Dim, Components>{patch, first, second, lanes_before<double>(nodes.second_run_begin)});
  }
  return read(OwnNodes<Dim, Components>(patch, nodes));
}

// Interpolates `Count` components of the surrounding records to the particles.
template <std::size_t Count, int Dim, std::size_t Width, int Components>
THAWSLIDE_ALWAYS_INLINE Reading<Dim, Simd<double>, Count> read_nodes(const BatchStencil<Dim, Width>& stencil,
                                                                     const Patch<Dim, Components>& patch,
                                                                     std::size_t first_component = 0) {
  return with_fetch(stencil.nodes, patch, [&](const auto& fetch) THAWSLIDE_INLINE_LAMBDA {
    return read_along_axes<Count>(stencil.axis, fetch, first_component);
  });
}
template <std::size_t Count, int Dim, int Components>
THAWSLIDE_ALWAYS_INLINE Reading<Dim, Simd<double>, Count> read_nodes(const LinearStencil<Dim>& linear,
                                                                     const Patch<Dim, Components>& patch,
                                                                     std::size_t first_component = 0) {
  if (linear.nodes.runs == BatchNodes::irregular) {
    const auto corners = linear.corners();
    return read_along_axes<Count>(corners.axis, OwnNodes<Dim, Components>(patch, corners.nodes), first_component);
  }
  return read_nodes<Count>(linear.about(), patch, first_component);
}

// Weights of one particle, each broadcast to a record register.
template <int Dim, class Register, std::size_t Width>
struct SpreadWeights {
  Register weight[Dim][Width];

  THAWSLIDE_ALWAYS_INLINE SpreadWeights(const BatchStencil<Dim, Width>& stencil, std::size_t lane) {
    unrolled<Dim * Width>([&](auto k) THAWSLIDE_INLINE_LAMBDA {
      weight[k / Width][k % Width] = stencil.axis[k / Width].weight[k % Width][lane];
    });
  }
};

// Interpolates one register of the surrounding records to one particle.
template <int Axis, int Dim, class Register, std::size_t Width>
THAWSLIDE_ALWAYS_INLINE Register sum_along_axes(const SpreadWeights<Dim, Register, Width>& spread,
                                                std::size_t record_size, const double* records) {
  constexpr auto stride = static_cast<std::size_t>(power(Tile<Dim>::patch_edge, Axis));
  Register sum = 0.0;
  unrolled<Width>([&](auto k) THAWSLIDE_INLINE_LAMBDA {
    const double* record = records + k * stride * record_size;
    if constexpr (Axis == 0) {
      sum += spread.weight[0][k] * Register::load(record);
    } else {
      sum += spread.weight[Axis][k] * sum_along_axes<Axis - 1>(spread, record_size, record);
    }
  });
  return sum;
}

// Interpolates all components of the surrounding records, without gradients, to a batch. For irregular nodes, the loop
// runs over particles with a register of components at a time.
template <int Dim, std::size_t Width, int Components>
THAWSLIDE_ALWAYS_INLINE std::array<Simd<double>, record_size(Components)> read_values(
    const BatchStencil<Dim, Width>& stencil, const Patch<Dim, Components>& patch) {
  using Register = RecordRegister<Components>;
  constexpr std::size_t lanes = simd_width<double>, size = record_size(Components), width = Register::count;
  std::array<Simd<double>, size> values;
  if (stencil.nodes.runs != BatchNodes::irregular) {
    const auto seen = read_nodes<static_cast<std::size_t>(Components)>(stencil, patch);
    unrolled<static_cast<std::size_t>(Components)>([&](auto c) THAWSLIDE_INLINE_LAMBDA { values[c] = seen.value[c]; });
    return values;
  }
  Register of_lane[size / width][lanes];
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const SpreadWeights<Dim, Register, Width> spread(stencil, lane);
    const double* records = patch.records[static_cast<std::size_t>(stencil.nodes.first[lane])].data();
    unrolled<size / width>([&](auto g) THAWSLIDE_INLINE_LAMBDA {
      of_lane[g][lane] = sum_along_axes<Dim - 1>(spread, size, records + g * width);
    });
  }
  unrolled<size / width>([&](auto g) THAWSLIDE_INLINE_LAMBDA { transpose_to_columns(of_lane[g], &values[g * width]); });
  return values;
}

// Contribution of a batch to the surrounding records: weight * value, plus gradient . flux in the components of one
// register.
template <int Dim, std::size_t Components>
struct Contribution {
  using Register = RecordRegister<static_cast<int>(Components)>;
  static constexpr std::size_t width = Register::count;  // components per register
  static constexpr std::size_t groups = record_size(static_cast<int>(Components)) / width;

  Simd<double> value[groups * width];
  Simd<double> flux[Dim][width];  // by axis

  Contribution() {
    unrolled<groups * width>([&](auto c) THAWSLIDE_INLINE_LAMBDA { value[c] = 0.0; });
    unrolled<Dim * width>([&](auto c) THAWSLIDE_INLINE_LAMBDA { flux[c / width][c % width] = 0.0; });
  }
};

}  // namespace thawslide::mpm
