// Particle position and size at t = 0, before particles are created.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/linear.hpp"

namespace thawslide::sim {

template <int Dim>
struct Seed {
  int body;
  Vector<double, Dim> place;               // absolute [m]
  double depth;                            // vertical, below the body's top [m]
  double volume;                           // [m3], per metre of width in 2D
  std::array<std::uint32_t, 3> lattice{};  // numbers of its column, row and layer, from the body's lowest corner
};

}  // namespace thawslide::sim
