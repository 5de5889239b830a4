// Erodible bed below the nodes of the grid on the CPU.
#pragma once

#include <cstdint>
#include <vector>

#include "exec/cpu.hpp"
#include "mpm/body_sizes.hpp"
#include "mpm/nodes.hpp"
#include "terrain/bed_stage.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::terrain {

template <int Dim>
class BedOnGrid : public BedStage<exec::Cpu, Dim> {
 public:
  using BedStage<exec::Cpu, Dim>::BedStage;

  // Marks the parts of the bed that particles cover, and distributes it over the loaded nodes (nodes.base).
  void update(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>& ground, const mpm::BodySizes& sizes,
              const mpm::Particles<Dim>& particles, mpm::Nodes<Dim>& nodes);
  // Bed below a candidate node: the argument of apply_contact.
  [[nodiscard]] BedBelowNode<Dim> below(const mpm::NodeAt& at, double area, double strength, double dt,
                                        double mass) const {
    return below_.below(first_[at.block] + at.node, area, strength, dt, mass);
  }

 private:
  void list_candidates(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>& ground);

  BedBelowNodes<Dim> below_{};
  std::vector<std::uint64_t> blocks_;    // of the candidates
  std::vector<mpm::NodeAt> candidates_;  // by block
  std::vector<std::size_t> first_;       // candidate of each block
};

}  // namespace thawslide::terrain
