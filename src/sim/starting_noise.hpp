// Random displacement of particles from their regular positions at t = 0.
#pragma once

#include "base/counter_random.hpp"
#include "config/case.hpp"
#include "sim/seed.hpp"

namespace thawslide::sim {

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
