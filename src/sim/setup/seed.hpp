// Particle position and size at t = 0, before particles are created.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/counter_random.hpp"
#include "base/linear.hpp"
#include "config/case.hpp"

namespace thawslide::sim {

template <int Dim>
struct Seed {
  int body;
  Vector<double, Dim> position;            // absolute [m]
  double depth;                            // vertical, below the body's top [m]
  double volume;                           // [m3], per metre of width in 2D
  std::array<std::uint32_t, 3> lattice{};  // numbers of its column, row and layer, from the body's lowest corner
  double lift = 0.0;  // from its place in the body's shape, with the ground of cells that follow the terrain [m]
};

// Displacement of a particle [m], at most initial.noise times `spacing` [m] in either direction along each axis. It
// depends on initial.seed, the body and the particle's place in that body's lattice.
template <int Dim>
Vector<double, Dim> starting_displacement(const config::Initial& initial, double spacing, const Seed<Dim>& seed) {
  const auto words = random_words({seed.lattice[0], seed.lattice[1], seed.lattice[2], 0},
                                  {static_cast<std::uint32_t>(initial.seed), static_cast<std::uint32_t>(seed.body)});
  Vector<double, Dim> displacement;
  for (int a = 0; a < Dim; ++a) {
    displacement[a] = initial.noise * spacing * between_minus_one_and_one(words[static_cast<std::size_t>(a)]);
  }
  return displacement;
}

}  // namespace thawslide::sim
