// How hard the slide presses on the ground: the normal pressure of Eq. 16 at contact nodes, and the area each stands
// for.
#pragma once

#include "mpm/nodes.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::terrain {

// Normal pressure [Pa] at the nodes of block b from nodes.base: load over dt and covered area, summed over a node and
// its neighbours with the weights 1/4, 1/2, 1/4 along the ground, and all of them across it: the rows that carry the
// load need not be those that have the area; 0 at nodes that do not press. Where a slope cuts through cells, a node's
// own load and its own area have little to do with each other; their local sums do. Exact where a deep slide ends on a
// grid line; the covered area is too small where it is thinner than a cell. Nodes no ground is near get a pressure as
// if `smallest_area` [m2] carried them.
template <int Dim, class Real>
std::array<Real, static_cast<std::size_t>(mpm::Tile<Dim>::nodes)> base_pressure(const mpm::SparseGrid<Dim, Real>& grid,
                                                                                const GroundOnGrid<Dim, Real>& ground,
                                                                                const mpm::Nodes<Dim, Real>& nodes,
                                                                                std::size_t b, Real dt,
                                                                                Real smallest_area);

}  // namespace thawslide::terrain
