// Sums of particle contributions to a patch in canonical order: over the particles of a cell (those with the same
// nearest node), then over cells. The sums are therefore independent of batch boundaries.
#pragma once

#include <algorithm>
#include <limits>

#include "mpm/batch_transfer.hpp"
#include "mpm/kernel.hpp"

namespace thawslide::mpm {

// Nodes in reach of the particles of a cell, 3 per axis.
template <int Dim>
struct CellNodes {
  static constexpr std::size_t count = static_cast<std::size_t>(power(3, Dim));
  // Place in the patch relative to the lowest node.
  static constexpr std::size_t index(std::size_t node) {
    constexpr auto edge = static_cast<std::size_t>(Tile<Dim>::patch_edge);
    return (node / 9 * edge + node / 3 % 3) * edge + node % 3;
  }
};

// Cell-wise sums in a patch. Contributions of a cell's particles are accumulated from zero in registers, a register of
// components at a time, and added to the patch at once. The sums are therefore independent of batch boundaries. First:
// first component. FluxGroup: number of the register, from there, to which the flux adds.
template <int FluxGroup, std::size_t First, std::size_t Carried, int Dim, int Components>
class CellSums {
  using Scatter = Contribution<Dim, Carried>;
  using Register = typename Scatter::Register;
  static constexpr std::size_t lanes = simd_width<double>, size = record_size(Components);
  static constexpr std::size_t groups = Scatter::groups, width = Scatter::width, nodes_per_axis = 3;
  static constexpr std::size_t layers = Dim == 3 ? nodes_per_axis : 1, layer_nodes = nodes_per_axis * nodes_per_axis;
  static_assert(size % width == 0 && First % width == 0 && First + groups * width <= size);

 public:
  explicit CellSums(Patch<Dim, Components>& patch, std::uint64_t /*rows*/ = 0) : patch_(patch) {}
  CellSums(const CellSums&) = delete;
  CellSums& operator=(const CellSums&) = delete;

  // Skips a batch instead of `add`; the rest of its first cell is then skipped too.
  void skip() { is_open_ = false; }

  // Adds the next `count` particles in canonical order.
  THAWSLIDE_ALWAYS_INLINE void add(const BatchStencil<Dim>& stencil, std::size_t count, const Scatter& carried) {
    Register value[groups][lanes], flux[Dim][lanes];
    unrolled<groups>([&](auto g) THAWSLIDE_INLINE_LAMBDA { transpose_to_rows(&carried.value[g * width], value[g]); });
    unrolled<static_cast<std::size_t>(Dim)>(
        [&](auto a) THAWSLIDE_INLINE_LAMBDA { transpose_to_rows(carried.flux[a], flux[a]); });
    const auto& nodes = stencil.nodes.first;
    for (std::size_t first = 0, last = 0; first < count; first = last) {
      while (last < count && nodes[last] == nodes[first]) {
        ++last;
      }
      const bool begins = first > 0 || !is_open_, ends = last < count || !stencil.nodes.continues;
      double* records = patch_.records[static_cast<std::size_t>(nodes[first])].data() + First;
      unrolled<groups>([&](auto g) THAWSLIDE_INLINE_LAMBDA {
        add_particles<static_cast<int>(g()) == FluxGroup>(stencil, first, last, value[g], flux, begins, ends, sums_[g],
                                                          records + g * width);
      });
    }
    is_open_ = stencil.nodes.continues;
  }

 private:
  // Adds particles first .. last-1 of a batch, all of one cell, by layers of nodes. Loops over axes, the last one
  // first, need fewer products than loops over nodes. value, flux: one row per particle.
  template <bool HasFlux>
  THAWSLIDE_ALWAYS_INLINE static void add_particles(const BatchStencil<Dim>& stencil, std::size_t first,
                                                    std::size_t last, const Register (&value)[lanes],
                                                    const Register (&flux)[Dim][lanes], bool begins, bool ends,
                                                    Register (&of_cell)[layers * layer_nodes], double* records) {
    for (std::size_t layer = 0; layer < layers; ++layer) {
      Register sums[layer_nodes];
      unrolled<layer_nodes>(
          [&](auto k) THAWSLIDE_INLINE_LAMBDA { sums[k] = begins ? Register(0.0) : of_cell[layer * layer_nodes + k]; });
      for (std::size_t lane = first; lane < last; ++lane) {
        const auto weight = [&](std::size_t axis, std::size_t k)
                                THAWSLIDE_INLINE_LAMBDA { return Register(stencil.axis[axis].weight[k][lane]); };
        const auto slope = [&](std::size_t axis, std::size_t k)
                               THAWSLIDE_INLINE_LAMBDA { return Register(stencil.axis[axis].slope[k][lane]); };
        Register in_layer = value[lane], along_0 = flux[0][lane], along_1 = flux[1][lane];
        if constexpr (Dim == 3) {
          in_layer *= weight(2, layer);
          if constexpr (HasFlux) {
            in_layer += slope(2, layer) * flux[2][lane];
            along_0 *= weight(2, layer);
            along_1 *= weight(2, layer);
          }
        }
        unrolled<nodes_per_axis>([&](auto j) THAWSLIDE_INLINE_LAMBDA {
          Register in_row = weight(1, j) * in_layer;
          if constexpr (HasFlux) {
            in_row += slope(1, j) * along_1;
          }
          const Register along = weight(1, j) * along_0;
          unrolled<nodes_per_axis>([&](auto i) THAWSLIDE_INLINE_LAMBDA {
            Register& sum = sums[j * nodes_per_axis + i];
            sum += weight(0, i) * in_row;
            if constexpr (HasFlux) {
              sum += slope(0, i) * along;
            }
          });
        });
      }
      unrolled<layer_nodes>([&](auto k) THAWSLIDE_INLINE_LAMBDA {
        if (ends) {
          double* record = records + CellNodes<Dim>::index(layer * layer_nodes + k) * size;
          (Register::load(record) + sums[k]).store(record);
        } else {
          of_cell[layer * layer_nodes + k] = sums[k];
        }
      });
    }
  }

  Patch<Dim, Components>& patch_;
  bool is_open_ = false;                           // the last cell of the last batch continues
  Register sums_[groups][layers * layer_nodes]{};  // of that cell
};

// The same for the linear shape functions. Particles reach the corners of the grid cell that they lie in, which can
// differ between particles with the same nearest node.
template <bool HasFlux, std::size_t First, std::size_t Carried, int Dim, int Components>
class LinearCellSums {
  using Scatter = Contribution<Dim, Carried>;
  using Register = typename Scatter::Register;
  static constexpr std::size_t lanes = simd_width<double>, size = record_size(Components), width = Scatter::width;
  static constexpr std::size_t nodes = CellNodes<Dim>::count;
  static_assert(Scatter::groups == 1 && First % width == 0 && First + width <= size);

 public:
  explicit LinearCellSums(Patch<Dim, Components>& patch, std::uint64_t /*rows*/ = 0) : patch_(patch) {}
  LinearCellSums(const LinearCellSums&) = delete;
  LinearCellSums& operator=(const LinearCellSums&) = delete;

  // Skips a batch instead of `add`; the rest of its first cell is then skipped too.
  void skip() { is_open_ = false; }

  // Adds the next `count` particles in canonical order.
  THAWSLIDE_ALWAYS_INLINE void add(const LinearStencil<Dim>& linear, std::size_t count, const Scatter& carried) {
    Register value[lanes], flux[Dim][lanes];
    transpose_to_rows(carried.value, value);
    if constexpr (HasFlux) {
      unrolled<static_cast<std::size_t>(Dim)>(
          [&](auto a) THAWSLIDE_INLINE_LAMBDA { transpose_to_rows(carried.flux[a], flux[a]); });
    }
    const auto corners = linear.corners();
    const auto& cells = linear.nodes.first;
    for (std::size_t lane = 0; lane < count; ++lane) {
      if (lane > 0 ? cells[lane] != cells[lane - 1] : !is_open_) {
        sums_.fill(Register(0.0));
      }
      add_particle(corners, lane, value[lane], flux, &sums_[static_cast<std::size_t>(corners.first_in_cell[lane])]);
      if (lane + 1 < count ? cells[lane] != cells[lane + 1] : !linear.nodes.continues) {
        end_cell(static_cast<std::size_t>(cells[lane]));
      }
    }
    is_open_ = linear.nodes.continues;
  }

 private:
  // Loops over axes, the last one first.
  THAWSLIDE_ALWAYS_INLINE static void add_particle(const CornerStencil<Dim>& corners, std::size_t lane,
                                                   const Register& value, const Register (&flux)[Dim][lanes],
                                                   Register* sums) {
    const auto weight = [&](std::size_t axis, std::size_t k)
                            THAWSLIDE_INLINE_LAMBDA { return Register(corners.axis[axis].weight[k][lane]); };
    const auto slope = [&](std::size_t axis, std::size_t k)
                           THAWSLIDE_INLINE_LAMBDA { return Register(corners.axis[axis].slope[k][lane]); };
    unrolled<Dim == 3 ? 2 : 1>([&](auto layer) THAWSLIDE_INLINE_LAMBDA {
      Register in_layer = value, along_0, along_1;
      if constexpr (HasFlux) {
        along_0 = flux[0][lane];
        along_1 = flux[1][lane];
      }
      if constexpr (Dim == 3) {
        in_layer *= weight(2, layer);
        if constexpr (HasFlux) {
          in_layer += slope(2, layer) * flux[2][lane];
          along_0 *= weight(2, layer);
          along_1 *= weight(2, layer);
        }
      }
      unrolled<2>([&](auto j) THAWSLIDE_INLINE_LAMBDA {
        Register in_row = weight(1, j) * in_layer;
        if constexpr (HasFlux) {
          in_row += slope(1, j) * along_1;
        }
        unrolled<2>([&](auto i) THAWSLIDE_INLINE_LAMBDA {
          Register& sum = sums[(layer * 3 + j) * 3 + i];
          sum += weight(0, i) * in_row;
          if constexpr (HasFlux) {
            sum += slope(0, i) * (weight(1, j) * along_0);
          }
        });
      });
    });
  }

  void end_cell(std::size_t first_node) {
    double* records = patch_.records[first_node].data() + First;
    unrolled<nodes>([&](auto k) THAWSLIDE_INLINE_LAMBDA {
      double* record = records + CellNodes<Dim>::index(k) * size;
      (Register::load(record) + sums_[k]).store(record);
    });
  }

  Patch<Dim, Components>& patch_;
  bool is_open_ = false;                // the last cell of the last batch continues
  std::array<Register, nodes> sums_{};  // of the current cell
};

// Contribution of a batch to min-reduced components.
template <int Dim>
using GapsOfBatch = GapsToPlanes<Simd<double>, Dim, const Patch<Dim, components_of<Planes, Dim>>*>;

// Minimum of component `Component` over a patch: the smallest gap between a node's plane and the particles that reach
// the node. Independent of the order.
template <std::size_t Component, int Dim, int Components>
class PatchMinima {
  static constexpr double largest = std::numeric_limits<double>::max();

 public:
  // rows: rows in which the particles have nodes (Tile::rows_from).
  PatchMinima(Patch<Dim, Components>& patch, std::uint64_t rows) : patch_(patch) {
    patch.for_rows(rows, [](auto* row) {
      std::for_each_n(row, Tile<Dim>::patch_edge, [](auto& record) { record[Component] = largest; });
    });
  }
  PatchMinima(const PatchMinima&) = delete;
  PatchMinima& operator=(const PatchMinima&) = delete;

  // Skips a batch instead of `add`; no state to reset.
  void skip() {}

  // Adds the next `count` particles.
  THAWSLIDE_ALWAYS_INLINE void add(const BatchStencil<Dim>& stencil, std::size_t count, const GapsOfBatch<Dim>& gaps) {
    const BatchNodes& nodes = stencil.nodes;
    const auto in_first = lanes_before<double>(nodes.runs == 1 ? simd_width<double> : nodes.second_run_begin);
    with_fetch(nodes, *gaps.planes, [&](const auto& fetch) {
      for_each_node<Dim>(
          stencil.axis, 0, [&](std::size_t offset, Simd<double> weight, const Vector<Simd<double>, Dim>& /*slope*/) {
            const Simd<double> gap =
                max(gaps.least, gap_to_plane<Dim>(gaps.position, [&](std::size_t component) THAWSLIDE_INLINE_LAMBDA {
                      return fetch(offset, component);
                    }));
            // Round-off decides whether a box that ends at the edge of a node's support overlaps it.
            const Simd<double> seen = select(weight > round_off, gap, Simd<double>(largest));
            if (nodes.runs == BatchNodes::irregular) {
              for (std::size_t lane = 0; lane < count; ++lane) {
                lower(nodes.first[lane], offset, seen[lane]);
              }
              return;
            }
            lower(nodes.first[0], offset, smallest(select(in_first, seen, Simd<double>(largest))));
            if (nodes.runs == 2) {
              lower(nodes.first[simd_width<double> - 1], offset,
                    smallest(select(in_first, Simd<double>(largest), seen)));
            }
          });
    });
  }

 private:
  THAWSLIDE_ALWAYS_INLINE void lower(std::int32_t first_node, std::size_t offset, double seen) {
    double& known = patch_.records[static_cast<std::size_t>(first_node) + offset][Component];
    known = std::min(known, seen);
  }

  Patch<Dim, Components>& patch_;
};

template <int FluxGroup, std::size_t Carried, std::size_t First = 0, int Dim, int Components>
THAWSLIDE_ALWAYS_INLINE auto cell_sums(Patch<Dim, Components>& patch) {
  return CellSums<FluxGroup, First, Carried, Dim, Components>(patch);
}

}  // namespace thawslide::mpm
