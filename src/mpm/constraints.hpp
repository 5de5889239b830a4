// Prescribed motion at nodes: boundaries of the domain (fixed, roller, open), moving rigid frames (Sec. 3.2), and held
// bodies.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "mpm/domain_faces.hpp"
#include "mpm/nodes.hpp"

namespace thawslide::mpm {

// Box that moves along one axis and prescribes that component of velocity at the nodes inside.
template <int Dim>
struct RigidFrame {
  Vector<double, Dim> lower, upper;  // at t = 0 [m], relative to the domain's lower corner
  int axis = 0;
  double velocity = 0;  // [m/s]

  [[nodiscard]] Vector<double, Dim> shift(double time) const {
    Vector<double, Dim> moved = Vector<double, Dim>::Zero();
    moved[axis] = velocity * time;
    return moved;
  }
};

template <int Dim>
struct Constraints : DomainFaces<Dim> {
  std::vector<RigidFrame<Dim>> frames;
  std::uint64_t first_held_layer = std::numeric_limits<std::uint64_t>::max();  // of the grid, and those after it

  // Sets the prescribed components of a node's momentum; true if a frame has set one.
  bool apply(const Vector<double, Dim>& position, double mass, double time, Vector<double, Dim>& momentum) const {
    this->apply_faces(position, momentum);
    bool in_frame = false;
    for (const RigidFrame<Dim>& frame : frames) {
      const Vector<double, Dim> in_frame_position = position - frame.shift(time);
      if ((in_frame_position.array() >= frame.lower.array()).all() &&
          (in_frame_position.array() <= frame.upper.array()).all()) {
        momentum[frame.axis] = mass * frame.velocity;
        in_frame = true;
      }
    }
    return in_frame;
  }

  // True if apply may set a component at positions between two corners.
  [[nodiscard]] bool may_apply(const Vector<double, Dim>& lower, const Vector<double, Dim>& upper, double time) const {
    for (int a = 0; a < Dim; ++a) {
      if ((this->at_lower(lower[a], a) && this->faces[2 * a] != BoundaryKind::open) ||
          (this->at_upper(upper[a], a) && this->faces[2 * a + 1] != BoundaryKind::open)) {
        return true;
      }
    }
    return std::any_of(frames.begin(), frames.end(), [&](const RigidFrame<Dim>& frame) {
      const Vector<double, Dim> shift = frame.shift(time);
      return ((upper - shift).array() >= frame.lower.array()).all() &&
             ((lower - shift).array() <= frame.upper.array()).all();
    });
  }
};

// Constraints on the nodes of one block; most blocks have none.
template <int Dim>
class BlockConstraints {
 public:
  BlockConstraints(const SparseGrid<Dim>& grid, const Constraints<Dim>& constraints, std::size_t block, double time)
      : grid_(&grid),
        constraints_(&constraints),
        block_(block),
        time_(time),
        is_held_(Tile<Dim>::layer(grid.blocks()[block]) >= constraints.first_held_layer),
        any_(is_held_ ||
             constraints.may_apply(node_position(grid, block, 0),
                                   node_position(grid, block, static_cast<std::size_t>(Tile<Dim>::nodes) - 1), time)) {}

  [[nodiscard]] bool any() const { return any_; }
  // True for the nodes of held bodies, which are fixed.
  [[nodiscard]] bool is_held() const { return is_held_; }
  // Applies Constraints::apply at a node of the block.
  bool apply(std::size_t node, double mass, Vector<double, Dim>& momentum) const {
    if (is_held_) {
      momentum.setZero();
      return false;
    }
    return any_ && constraints_->apply(node_position(*grid_, block_, node), mass, time_, momentum);
  }

 private:
  const SparseGrid<Dim>* grid_;
  const Constraints<Dim>* constraints_;
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
