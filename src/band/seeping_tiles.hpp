// Tiles and blocks with seepage.
#pragma once

#include <algorithm>

#include "base/parallel.hpp"
#include "mpm/nodes.hpp"

namespace thawslide::band {

// Marks the tiles with a batch for which seeps(batch) is true, and the blocks around them. Returns false if there are
// none.
template <int Dim, class Seeps>
bool find_seepage(const mpm::SparseGrid<Dim>& grid, mpm::ActivityMarks& marks, const Seeps& seeps) {
  marks.seeping_tiles.resize(grid.tiles().size());
  parallel_for(grid.tiles().size(), [&](std::size_t t) {
    const auto& batches = grid.batches(t);
    marks.seeping_tiles[t] = std::any_of(batches.begin(), batches.end(), seeps) ? 1 : 0;
  });
  grid.mark_blocks_about(marks.seeping_tiles, marks.seeping_blocks);
  return std::any_of(marks.seeping_tiles.begin(), marks.seeping_tiles.end(),
                     [](std::uint8_t found) { return found != 0; });
}

}  // namespace thawslide::band
