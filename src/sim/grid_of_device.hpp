// Host copy of a device's grid without particles, for the parts of the step on the CPU: the nodal values that band
// columns read.
#pragma once

#include <cstdint>
#include <vector>

#include "mpm/nodes.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::sim {

template <int Dim>
struct GridOfDevice {
  GridOfDevice(Real cell, const mpm::Mapping& mapping) : grid(cell, {}, mapping) {}

  mpm::SparseGrid<Dim> grid;
  terrain::GroundOnGrid<Dim> ground;
  mpm::Nodes<Dim> nodes;
  std::vector<std::uint32_t> requested_blocks;  // blocks whose nodes the device transfers
  std::vector<Real> states;                     // records of BaseState of candidate nodes
};

}  // namespace thawslide::sim
