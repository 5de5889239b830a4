// Transfers of one particle per thread: weights, gather and contributions. For host and device
// (device/particle_pass.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "base/linear.hpp"
#include "base/select.hpp"
#include "mpm/mapping.hpp"
#include "mpm/reading.hpp"
#include "mpm/records.hpp"
#include "mpm/scalar_index.hpp"

namespace thawslide::mpm {

// Contribution of one particle to a record: weight * value, plus gradient . flux in the first `record_step` components.
template <int Dim, bool HasFlux>
struct OneFlux {};
template <int Dim>
struct OneFlux<Dim, true> {
  double flux[Dim][record_step] = {};
};
template <int Dim, std::size_t Components, bool HasFlux>
struct OneContribution : OneFlux<Dim, HasFlux> {
  static constexpr std::size_t size = record_size(static_cast<int>(Components));
  static constexpr std::size_t width = record_step;  // components with a flux

  double value[size] = {};
};

// Contribution to min-reduced components. planes: consecutive records of the tile's patch.
template <int Dim>
using OneGaps = GapsToPlanes<double, Dim, const double*>;

// Contribution of one particle to a record, by name.
template <class Name, int Dim>
using CarriedByOne = std::conditional_t<IsMinReduced<Name>, OneGaps<Dim>,
                                        OneContribution<Dim, scatter_size<Name, Dim>, Name::flux != no_flux>>;

// Position of a particle: offset from its nearest node, in cells; place in the tile's patch of the lowest node in
// reach; and, along each axis, whether the nearest node lies on a side of the domain that prescribes velocity.
template <int Dim>
struct OneGridPosition {
  Vector<double, Dim> offset;
  std::size_t first_node;
  std::array<bool, static_cast<std::size_t>(Dim)> at_side;
};

// Weights by axis, and place in the patch of the lowest node.
template <int Dim, std::size_t Width>
struct OneStencil {
  std::array<AxisWeights<double, Width>, static_cast<std::size_t>(Dim)> axis;
  std::uint32_t first = 0;
  // index of that node along each axis, among the 3 nodes of the cell
  std::array<std::uint8_t, static_cast<std::size_t>(Dim)> in_cell{};
};

// Weights of one particle; those of momentum and APIC if the pass has them.
template <int Dim>
struct OneWeights {
  static constexpr int dimensions = Dim;

  OneStencil<Dim, 2> linear;
  OneStencil<Dim, 3> momentum, affine;
  Vector<double, Dim> moment;
  MappingAt<Dim, double> mapping, linear_mapping;

  template <class Particles>
  THAWSLIDE_HD OneWeights(const Mapping& grid, const Particles& particles, const ScalarIndex& at)
      : mapping(grid, particles.ground_slope, at), linear_mapping(grid, particles.linear_slope, at) {}

  // Weights at the corners of the grid cell that contains the particle.
  THAWSLIDE_HD void set_linear(const OneGridPosition<Dim>& at, double inverse_cell) {
    linear.first = static_cast<std::uint32_t>(at.first_node);
    for (std::size_t a = 0; a < Dim; ++a) {
      const double along = at.offset[static_cast<int>(a)];
      const bool right = along >= 0.0;
      linear.in_cell[a] = right ? 1 : 0;
      linear.first += right ? static_cast<std::uint32_t>(power(Tile<Dim>::patch_edge, static_cast<int>(a))) : 0u;
      linear.axis[a] = {{right ? 1.0 - along : -along, right ? along : 1.0 + along}, {-inverse_cell, inverse_cell}};
    }
  }
  template <class Shape>
  THAWSLIDE_HD void set_momentum(const OneGridPosition<Dim>& at, const HalfSize<double>& size, double inverse_cell) {
    momentum.first = static_cast<std::uint32_t>(at.first_node);
    for (std::size_t a = 0; a < Dim; ++a) {
      momentum.axis[a] = Shape::weights(at.offset[static_cast<int>(a)], size, at.at_side[a], inverse_cell);
    }
  }
  // Call after set_momentum.
  template <class Shape>
  THAWSLIDE_HD void set_affine(const OneGridPosition<Dim>& at, double cell, double inverse_cell) {
    affine = momentum;
    for (std::size_t a = 0; a < Dim; ++a) {
      const double along = at.offset[static_cast<int>(a)];
      affine.axis[a] = Shape::affine(momentum.axis[a], along, at.at_side[a], inverse_cell);
      moment[static_cast<int>(a)] = mpm::second_moment(momentum.axis[a], along) * (cell * cell);
    }
  }

  template <class Functions>
  [[nodiscard]] THAWSLIDE_HD const auto& of() const {
    if constexpr (std::is_same_v<Functions, LinearFunctions>) {
      return linear;
    } else if constexpr (std::is_same_v<Functions, AffineFunctions>) {
      return affine;
    } else {
      return momentum;
    }
  }
  template <class Functions>
  [[nodiscard]] THAWSLIDE_HD const auto& mapping_of() const {
    if constexpr (std::is_same_v<Functions, LinearFunctions>) {
      return linear_mapping;
    } else {
      return mapping;
    }
  }
  // As those of a batch.
  using Square = Matrix<double, Dim>;
  [[nodiscard]] THAWSLIDE_HD Square affine_on_grid(const Square& gradient) const { return mapping.on_grid(gradient); }
  [[nodiscard]] THAWSLIDE_HD Square affine_moment(const Square& gradient) const {
    return affine_on_grid(gradient) * moment.asDiagonal();
  }
};

// Gather of one particle from the surrounding records.
template <class Weights, class Patches>
struct ScalarGather {
  const Weights& weights;
  const Patches& patches;

  template <class Name, std::size_t Count>
  [[nodiscard]] THAWSLIDE_HD auto read(std::size_t first = 0) const {
    const auto& stencil = weights.template of<typename Name::Functions>();
    const auto& patch = patches.template of<Name>();
    return weights.template mapping_of<typename Name::Functions>().in_space(read_along_axes<Count>(
        stencil.axis,
        [&](std::size_t index, std::size_t component) {
          return patch.numbers[(stencil.first + index) * patch.size + component];
        },
        first));
  }
  template <class Name>
  [[nodiscard]] THAWSLIDE_HD const auto* planes() const {
    return patches.template of<Name>().numbers;
  }
  template <class Name>
  [[nodiscard]] THAWSLIDE_HD auto values() const {
    return read<Name, static_cast<std::size_t>(components_of<Name, Weights::dimensions>)>().value;
  }
};

// Weights and slopes of a particle at a node along each axis, and the node's place in the tile's patch. is_seen: the
// node is in reach.
template <int Dim>
struct OneAtNode {
  bool is_seen = true;
  std::size_t index = 0;
  double weight[Dim], slope[Dim];
};
// node: index along each axis in the particle's cell.
template <int Dim, std::size_t Width>
THAWSLIDE_HD OneAtNode<Dim> at_node(const OneStencil<Dim, Width>& stencil, const std::array<std::size_t, 3>& node) {
  OneAtNode<Dim> at;
  at.index = stencil.first;
  for (std::size_t a = 0; a < Dim; ++a) {
    const std::size_t k = node[a] - stencil.in_cell[a];  // wraps to a large number if it would be negative
    at.is_seen = at.is_seen && k < Width;
    at.weight[a] = stencil.axis[a].weight[k < Width ? k : 0];
    at.slope[a] = stencil.axis[a].slope[k < Width ? k : 0];
    at.index += k * static_cast<std::size_t>(power(Tile<Dim>::patch_edge, static_cast<int>(a)));
  }
  return at;
}

// Component c of a node after adding a particle in reach. sum: value before.
template <int Dim, std::size_t Components, bool HasFlux>
THAWSLIDE_HD double add_particle(const OneAtNode<Dim>& at, const OneContribution<Dim, Components, HasFlux>& carried,
                                 std::size_t c, double sum) {
  const bool with_flux = HasFlux && c < record_step;
  double in_layer = carried.value[c];
  double along_0 = 0, along_1 = 0;
  if constexpr (HasFlux) {
    along_0 = with_flux ? carried.flux[0][c] : 0.0;
    along_1 = with_flux ? carried.flux[1][c] : 0.0;
  }
  if constexpr (Dim == 3) {
    in_layer *= at.weight[2];
    if constexpr (HasFlux) {
      if (with_flux) {
        in_layer += at.slope[2] * carried.flux[2][c];
        along_0 *= at.weight[2];
        along_1 *= at.weight[2];
      }
    }
  }
  double in_row = at.weight[1] * in_layer;
  if (with_flux) {
    in_row += at.slope[1] * along_1;
  }
  const double along = at.weight[1] * along_0;
  sum += at.weight[0] * in_row;
  if (with_flux) {
    sum += at.slope[0] * along;
  }
  return sum;
}
template <int Dim>
THAWSLIDE_HD double add_particle(const OneAtNode<Dim>& at, const OneGaps<Dim>& carried, std::size_t /*c*/,
                                 double smallest) {
  double weight = 1.0;
  for (std::size_t a = 0; a < Dim; ++a) {
    weight *= at.weight[a];
  }
  if (!(weight > round_off)) {
    return smallest;
  }
  const double* record = carried.planes + at.index * record_size(components_of<Planes, Dim>);
  return min(smallest,
             max(carried.least, gap_to_plane<Dim>(carried.position, [&](std::size_t k) { return record[k]; })));
}

}  // namespace thawslide::mpm
