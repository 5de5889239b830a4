// Prescribed motion at the nodes of blocks, and held bodies.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "mpm/nodes.hpp"
#include "mpm/prescribed_motion.hpp"

namespace thawslide::mpm {

template <int Dim>
struct Constraints : DomainFaces<Dim> {
  std::vector<RigidFrame<Dim>> frames;
  std::uint64_t first_held_layer = std::numeric_limits<std::uint64_t>::max();  // of the grid, and those after it

  [[nodiscard]] PrescribedMotion<Dim> motion() const { return {*this, frames.data(), frames.size()}; }
};

// Constraints on the nodes of one block; most blocks have none.
template <int Dim>
class BlockConstraints {
 public:
  BlockConstraints(const SparseGrid<Dim>& grid, const Constraints<Dim>& constraints, std::size_t block, double time)
      : grid_(&grid),
        motion_(constraints.motion()),
        block_(block),
        time_(time),
        is_held_(Tile<Dim>::layer(grid.blocks()[block]) >= constraints.first_held_layer),
        any_(is_held_ ||
             motion_.may_apply(node_position(grid, block, 0),
                               node_position(grid, block, static_cast<std::size_t>(Tile<Dim>::nodes) - 1), time)) {}

  [[nodiscard]] bool any() const { return any_; }
  // True for the nodes of held bodies, which are fixed.
  [[nodiscard]] bool is_held() const { return is_held_; }
  // Sets the prescribed components of the momentum of a node of the block; true if a frame has set one.
  bool apply(std::size_t node, double mass, Vector<double, Dim>& momentum) const {
    if (is_held_) {
      momentum.setZero();
      return false;
    }
    return any_ && motion_.apply(node_position(*grid_, block_, node), mass, time_, momentum);
  }

 private:
  const SparseGrid<Dim>* grid_;
  PrescribedMotion<Dim> motion_;
  std::size_t block_;
  double time_;
  bool is_held_, any_;
};

// Constraints at one node of a block.
template <int Dim>
struct NodeConstraints {
  const BlockConstraints<Dim>& of_block;
  std::size_t node;

  [[nodiscard]] bool any() const { return of_block.any(); }
  [[nodiscard]] bool is_held() const { return of_block.is_held(); }
  bool apply(double mass, Vector<double, Dim>& momentum) const { return of_block.apply(node, mass, momentum); }
};

}  // namespace thawslide::mpm
