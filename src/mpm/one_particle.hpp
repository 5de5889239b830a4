// What a thread with one particle does in a pass: the particle's weights, what it reads by them, what it adds. On the
// processor and on devices alike (device/particle_pass.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#include "base/linear.hpp"
#include "base/select.hpp"
#include "mpm/one.hpp"
#include "mpm/reading.hpp"
#include "mpm/records.hpp"

namespace thawslide::mpm {

// What one particle carries to a record: weight * value, and in its first numbers also gradient . flux.
template <class Real, int Dim, std::size_t Components>
struct OneContribution {
  static constexpr std::size_t size = record_size(static_cast<int>(Components));

  Real value[size] = {};
  Real flux[Dim][record_step] = {};
};

// The same of what it lowers.
template <class Real, std::size_t Count>
struct OneBounds : Bounds<Real, Count> {};

// What one particle carries to a record of some name.
template <class Name, int Dim, class Real>
using CarriedByOne = std::conditional_t<IsLowered<Name>, OneBounds<Real, carried_numbers<Name, Dim>>,
                                        OneContribution<Real, Dim, carried_numbers<Name, Dim>>>;

// Where a particle stands: from its nearest node, in cells; the lowest node that it sees, by its place in the tile's
// patch; whether the nearest node lies, along each axis, on a side of the domain that prescribes velocity.
template <int Dim, class Real>
struct OnePlace {
  Vector<Real, Dim> offset;
  std::size_t first_node;
  std::array<bool, static_cast<std::size_t>(Dim)> at_side;
};

// Weights by axis, and the place in the patch of the lowest of the nodes.
template <class Real, int Dim, std::size_t Width>
struct OneStencil {
  std::array<AxisWeights<Real, Width>, static_cast<std::size_t>(Dim)> axis;
  std::size_t first = 0;
  std::array<std::size_t, static_cast<std::size_t>(Dim)> in_cell{};  // of that node among the 3 an axis of its cell
};

// The weights of one particle; those of momentum and of APIC where the pass has them.
template <int Dim, class Real>
struct OneWeights {
  static constexpr int dimensions = Dim;

  OneStencil<Real, Dim, 2> linear;
  OneStencil<Real, Dim, 3> momentum, affine;
  Vector<Real, Dim> moment;

  // At the corners of the cell of nodes in which the particle lies.
  THAWSLIDE_HD void set_linear(const OnePlace<Dim, Real>& place, Real inverse_cell) {
    linear.first = place.first_node;
    for (std::size_t a = 0; a < Dim; ++a) {
      const Real along = place.offset[static_cast<int>(a)];
      const bool right = along >= Real(0);
      linear.in_cell[a] = right ? 1 : 0;
      linear.first += right ? static_cast<std::size_t>(power(Tile<Dim>::patch_edge, static_cast<int>(a))) : 0;
      linear.axis[a] = {{right ? Real(1) - along : -along, right ? along : Real(1) + along},
                        {-inverse_cell, inverse_cell}};
    }
  }
  template <class Shape>
  THAWSLIDE_HD void set_momentum(const OnePlace<Dim, Real>& place, const HalfSize<Real>& size, Real inverse_cell) {
    momentum.first = place.first_node;
    for (std::size_t a = 0; a < Dim; ++a) {
      momentum.axis[a] = Shape::weights(place.offset[static_cast<int>(a)], size, place.at_side[a], inverse_cell);
    }
  }
  // After set_momentum.
  template <class Shape>
  THAWSLIDE_HD void set_affine(const OnePlace<Dim, Real>& place, Real cell, Real inverse_cell) {
    affine = momentum;
    for (std::size_t a = 0; a < Dim; ++a) {
      const Real along = place.offset[static_cast<int>(a)];
      affine.axis[a] = Shape::affine(momentum.axis[a], along, place.at_side[a], inverse_cell);
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
  [[nodiscard]] THAWSLIDE_HD const Vector<Real, Dim>& second_moment() const { return moment; }
};

// What one particle sees of the records about it.
template <class Weights, class Patches>
struct SeenByOne {
  const Weights& weights;
  const Patches& patches;

  template <class Name, std::size_t Count>
  [[nodiscard]] THAWSLIDE_HD auto read(std::size_t first = 0) const {
    const auto& stencil = weights.template of<typename Name::Functions>();
    const auto& patch = patches.template of<Name>();
    return read_along_axes<Count>(
        stencil.axis,
        [&](std::size_t place, std::size_t component) {
          return patch.numbers[(stencil.first + place) * patch.size + component];
        },
        first);
  }
  template <class Name>
  [[nodiscard]] THAWSLIDE_HD auto values() const {
    return read<Name, static_cast<std::size_t>(components_of<Name, Weights::dimensions>)>().value;
  }
};

// A node of a particle's cell, numbered along each axis: k is its number among those that the particle sees. False if
// it sees another.
template <int Dim, class Real, std::size_t Width>
THAWSLIDE_HD bool find_in_stencil(const OneStencil<Real, Dim, Width>& stencil, const std::array<std::size_t, 3>& node,
                                  std::array<std::size_t, static_cast<std::size_t>(Dim)>& k) {
  for (std::size_t a = 0; a < Dim; ++a) {
    if (node[a] < stencil.in_cell[a] || node[a] >= stencil.in_cell[a] + Width) {
      return false;
    }
    k[a] = node[a] - stencil.in_cell[a];
  }
  return true;
}

// Component c of such a node after the particle, `sum` before it.
template <int Dim, class Real, std::size_t Width, std::size_t Components>
THAWSLIDE_HD Real add_particle(const OneStencil<Real, Dim, Width>& stencil, const std::array<std::size_t, 3>& node,
                               const OneContribution<Real, Dim, Components>& carried, bool has_flux, std::size_t c,
                               Real sum) {
  std::array<std::size_t, static_cast<std::size_t>(Dim)> k{};
  if (!find_in_stencil(stencil, node, k)) {
    return sum;
  }
  const auto& axis = stencil.axis;
  const bool with_flux = has_flux && c < record_step;
  Real in_layer = carried.value[c];
  Real along_0 = with_flux ? carried.flux[0][c] : Real(0), along_1 = with_flux ? carried.flux[1][c] : Real(0);
  if constexpr (Dim == 3) {
    in_layer *= axis[2].weight[k[2]];
    if (with_flux) {
      in_layer += axis[2].slope[k[2]] * carried.flux[2][c];
      along_0 *= axis[2].weight[k[2]];
      along_1 *= axis[2].weight[k[2]];
    }
  }
  Real in_row = axis[1].weight[k[1]] * in_layer;
  if (with_flux) {
    in_row += axis[1].slope[k[1]] * along_1;
  }
  const Real along = axis[1].weight[k[1]] * along_0;
  sum += axis[0].weight[k[0]] * in_row;
  if (with_flux) {
    sum += axis[0].slope[k[0]] * along;
  }
  return sum;
}
template <int Dim, class Real, std::size_t Width, std::size_t Count>
THAWSLIDE_HD Real add_particle(const OneStencil<Real, Dim, Width>& stencil, const std::array<std::size_t, 3>& node,
                               const OneBounds<Real, Count>& carried, bool /*has_flux*/, std::size_t c, Real smallest) {
  std::array<std::size_t, static_cast<std::size_t>(Dim)> k{};
  if (!find_in_stencil(stencil, node, k)) {
    return smallest;
  }
  Real weight = Real(1);
  for (std::size_t a = 0; a < Dim; ++a) {
    weight *= stencil.axis[a].weight[k[a]];
  }
  return weight > round_off<Real> ? min(smallest, carried.value[c]) : smallest;
}

}  // namespace thawslide::mpm
