// Nodes of a block in a step on the CPU (terrain/contact_stage.hpp).
#pragma once

#include "mpm/constraints.hpp"
#include "terrain/contact.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::terrain {

template <int Dim>
class BlockStep {
 public:
  static constexpr int dim = Dim;

  // ground: null if there is none.
  BlockStep(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>* ground, const mpm::Constraints<Dim>& constraints,
            const ContactModel<Dim>& model, double time, double dt, mpm::Nodes<Dim>& of_grid, std::size_t block)
      : nodes{grid, of_grid},
        time(time),
        dt(dt),
        options(model),
        block(block),
        candidates(ground != nullptr ? ground->candidates(block) : 0),
        grid_(grid),
        known_(candidates > 0 ? &ground->block(block) : nullptr),
        width_(model.width.view()),
        constraints_(grid, constraints, block, time) {}

  mpm::NodeAccess<Dim> nodes;
  double time, dt;
  const ContactOptions& options;
  std::size_t block;
  std::size_t candidates;  // its first nodes (GroundOnGrid)

  [[nodiscard]] mpm::NodeConstraints<Dim> walls(const mpm::NodeAt& at) const { return constraints_.at(at.node); }
  [[nodiscard]] const GroundAtNode<Dim>& ground(const mpm::NodeAt& at) const { return (*known_)[at.node]; }
  [[nodiscard]] double space(const mpm::NodeAt& at) const {
    const double cell = grid_.cell();
    return (Dim == 2 ? width_.at(mpm::node_position(grid_, at.block, at.node)[0]) : cell) * cell * cell;
  }
  bool find_above(const mpm::NodeAt& at, int step, mpm::NodeAt& found) const {
    const auto adjacent = mpm::Tile<Dim>::adjacent(static_cast<int>(at.node), Dim - 1, step);
    const std::int32_t other = grid_.blocks_about_block(at.block)[adjacent.direction];
    found = {static_cast<std::size_t>(other), static_cast<std::size_t>(adjacent.local)};
    return other != KeyIndex::absent;
  }

 private:
  const mpm::SparseGrid<Dim>& grid_;
  const typename GroundOnGrid<Dim>::Block* known_;  // ground at the nodes of the block
  mpm::WidthView width_;
  mpm::BlockConstraints<Dim> constraints_;
};

}  // namespace thawslide::terrain
