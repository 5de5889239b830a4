// Normal pressure on the ground at contact nodes (Eq. 16), which also determines their contact areas.
#pragma once

#include "mpm/nodes.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::terrain {

// Normal pressure [Pa] at the nodes of block b from nodes.base; 0 at nodes without load. Load over dt and covered area
// are summed over a node and its neighbours. The weights are 1/4, 1/2, 1/4 along the ground and 1 across it, because
// the rows that carry the load can differ from those that have the area. If a slope cuts through cells, the load and
// the area of a single node are unrelated, but their local sums are consistent. Exact if a deep body ends on a grid
// line; the covered area is too small if the body is thinner than a cell. On cells that follow the ground, load and
// area of a column of nodes belong together, and there are no sums along the ground. Without ground nearby, the area is
// `smallest_area` [m2].
template <int Dim>
std::array<Real, static_cast<std::size_t>(mpm::Tile<Dim>::nodes)> base_pressure(const mpm::SparseGrid<Dim>& grid,
                                                                                const GroundOnGrid<Dim>& ground,
                                                                                const mpm::Nodes<Dim>& nodes,
                                                                                std::size_t b, Real dt,
                                                                                Real smallest_area);

}  // namespace thawslide::terrain
