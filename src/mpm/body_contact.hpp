// Contact between bodies that do not share nodes. Each body has separate blocks (a layer of the grid). At nodes where
// two bodies have mass, they exchange momentum if they approach and the gap between their particles is closed. A held
// body is a fixed wall for the others.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mpm/between_bodies.hpp"
#include "mpm/body_sizes.hpp"
#include "mpm/nodes.hpp"
#include "mpm/particles.hpp"
#include "mpm/sparse_grid.hpp"

namespace thawslide::mpm {

template <int Dim>
class BodyContact {
 public:
  // Adds the contact forces between bodies in this step to nodes.momentum.
  void add_forces(const SparseGrid<Dim>& grid, const Particles<Dim>& particles, const BetweenBodies& between,
                  const BodySizes& sizes, double mass_damping, double dt, Nodes<Dim>& nodes);
  // Removes the approach of bodies in contact from the mapped-back velocities, without friction.
  [[nodiscard]] BodyContactWork constrain_mapped_back(const Vector<double, Dim>& gravity, double dt,
                                                      Nodes<Dim>& nodes) const;

 private:
  using T = Tile<Dim>;
  using Vec = Vector<double, Dim>;
  static constexpr auto block_nodes = static_cast<std::size_t>(T::nodes);

  // Contact of two bodies at a node. impulse: on the second one [N s]; opposite on the first.
  struct Meeting {
    bool in_contact = false;
    Vec normal = Vec::Zero();  // from the first body to the second
    Vec impulse = Vec::Zero();
    double gap = 0;  // [m]
  };
  // Gradients on the grid along the candidate normals of a node: from both bodies, the first, the second.
  using Gradients = std::array<Vec, 3>;
  // Blocks of two layers at the same place.
  struct Pair {
    std::uint64_t tile;
    std::size_t block, other;
    bool other_is_held;
    double friction;
    std::array<Meeting, block_nodes> at;
  };

  void find_pairs(const SparseGrid<Dim>& grid, const BetweenBodies& between);
  [[nodiscard]] static bool find_meetings(const Nodes<Dim>& nodes, Pair& pair);
  [[nodiscard]] static std::array<Gradients, block_nodes> find_gradients(const SparseGrid<Dim>& grid,
                                                                         const Nodes<Dim>& nodes, const Pair& pair);
  static void find_gaps(const SparseGrid<Dim>& grid, const Particles<Dim>& particles, const BodySizes& sizes,
                        const std::array<Gradients, block_nodes>& gradients, Pair& pair);
  static void exchange(double mass_damping, double dt, Nodes<Dim>& nodes, Pair& pair);

  std::vector<Pair> pairs_;                 // by place, then by block
  std::vector<std::size_t> first_of_tile_;  // with the end appended
};

}  // namespace thawslide::mpm
