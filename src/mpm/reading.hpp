// Interpolation of nodal records to particles.
#pragma once

#include <array>
#include <cstddef>

#include "base/linear.hpp"
#include "base/select.hpp"
#include "mpm/shape.hpp"
#include "mpm/tile.hpp"

namespace thawslide::mpm {

// Interpolated values of `Count` components and their gradients [per m]. Loops over axes, rows first, need fewer
// products than loops over nodes.
template <int Dim, class Value, std::size_t Count>
struct Reading {
  std::array<Value, Count> value;
  std::array<std::array<Value, Count>, Dim> gradient;
};

// fetch(place, component): number at a place relative to the lowest node.
template <std::size_t Count, std::size_t Dim, class Value, std::size_t Width, class Fetch>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Reading<static_cast<int>(Dim), Value, Count> read_along_axes(
    const std::array<AxisWeights<Value, Width>, Dim>& axis, const Fetch& fetch, std::size_t first_component) {
  constexpr auto edge = static_cast<std::size_t>(Tile<static_cast<int>(Dim)>::patch_edge);
  constexpr std::size_t layers = Dim == 3 ? Width : 1;
  Reading<static_cast<int>(Dim), Value, Count> reading;
  unrolled<Count>([&](auto c) THAWSLIDE_INLINE_LAMBDA {
    Value value = 0, slopes[3] = {0, 0, 0};
    for (std::size_t k = 0; k < layers; ++k) {
      Value in_layer = 0, slope_0 = 0, slope_1 = 0;
      for (std::size_t j = 0; j < Width; ++j) {
        Value along = 0, slope = 0;
        for (std::size_t i = 0; i < Width; ++i) {
          const Value number = fetch((k * edge + j) * edge + i, first_component + c);
          along += axis[0].weight[i] * number;
          slope += axis[0].slope[i] * number;
        }
        in_layer += axis[1].weight[j] * along;
        slope_0 += axis[1].weight[j] * slope;
        slope_1 += axis[1].slope[j] * along;
      }
      if constexpr (Dim == 2) {
        value = in_layer;
        slopes[0] = slope_0;
        slopes[1] = slope_1;
      } else {
        value += axis[2].weight[k] * in_layer;
        slopes[0] += axis[2].weight[k] * slope_0;
        slopes[1] += axis[2].weight[k] * slope_1;
        slopes[2] += axis[2].slope[k] * in_layer;
      }
    }
    reading.value[c] = value;
    for (std::size_t b = 0; b < Dim; ++b) {
      reading.gradient[b][c] = slopes[b];
    }
  });
  return reading;
}

// Gradient of component c, and of the vector of the first Dim components: d v_a / d x_b.
template <int Dim, class Value, std::size_t Count>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Vector<Value, Dim> gradient_of(const Reading<Dim, Value, Count>& reading,
                                                                    std::size_t c) {
  Vector<Value, Dim> gradient;
  for (int b = 0; b < Dim; ++b) {
    gradient[b] = reading.gradient[static_cast<std::size_t>(b)][c];
  }
  return gradient;
}
template <int Dim, class Value, std::size_t Count>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Matrix<Value, Dim> gradient_of(const Reading<Dim, Value, Count>& reading) {
  Matrix<Value, Dim> gradient;
  for (int a = 0; a < Dim; ++a) {
    for (int b = 0; b < Dim; ++b) {
      gradient(a, b) = reading.gradient[static_cast<std::size_t>(b)][static_cast<std::size_t>(a)];
    }
  }
  return gradient;
}

}  // namespace thawslide::mpm
