// Prescribed motion at the nodes of blocks, and held bodies.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "mpm/nodes.hpp"
#include "mpm/prescribed_motion.hpp"

namespace thawslide::mpm {

template <int Dim>
struct Constraints {
  Vector<double, Dim> extent;  // upper corner of the domain [m]; the lower corner is the origin
  std::vector<NodeCondition<Dim>> conditions;
  std::uint64_t first_held_layer = std::numeric_limits<std::uint64_t>::max();  // of the grid, and those after it

  [[nodiscard]] PrescribedMotion<Dim> motion() const { return {conditions.data(), conditions.size()}; }
};

// Constraints on the nodes of one block; most blocks have none.
template <int Dim>
class BlockConstraints {
 public:
  BlockConstraints(const SparseGrid<Dim>& grid, const Constraints<Dim>& constraints, std::size_t block, double time)
      : grid_(&grid),
        motion_(constraints.motion()),
        time_(time),
        held_(Tile<Dim>::layer(grid.blocks()[block]) >= constraints.first_held_layer),
        may_apply_(motion_.may_apply(node_position(grid, block, 0),
                                     node_position(grid, block, static_cast<std::size_t>(Tile<Dim>::nodes) - 1),
                                     time)) {}

  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE NodeConstraints<Dim> operator()(const NodeAt& at) const {
    const Vector<double, Dim> unused = Vector<double, Dim>::Zero();
    return {motion_, may_apply_ ? node_position(*grid_, at.block, at.node) : unused, time_, held_, may_apply_};
  }

 private:
  const SparseGrid<Dim>* grid_;
  PrescribedMotion<Dim> motion_;
  double time_;
  bool held_, may_apply_;
};

}  // namespace thawslide::mpm
