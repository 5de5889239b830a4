// Sums over the boxes of particles at places, such as columns of cells or cells of a map below them. Places belong to
// groups of tiles; boxes are added in canonical order. Boxes, for CPU and devices, provide
//   Part, Box                            sum at a place; box of a particle
//   groups(), group(g)                   number of groups, which have no place in common, and data of one, `here`:
//                                        here.tiles(), here.tile(k), here.places()
//   spans(here, particles, at)           of the boxes of a batch, or of one particle
//   box(particles, p, spans, lane)       box of particle p, in this lane
//   for_places(here, box, visit)         calls visit(place, share) for the places below a box
//   share(here, box, place)              share of a place; converts to false if it is not below the box
//   part(here, place)                    pointer to the sum; null if the group has no such place
//   add(box, share, part)                adds the share of a box
#pragma once

#include "base/parallel.hpp"
#include "mpm/sparse_grid.hpp"

namespace thawslide::mpm {

// On the CPU. device::AddBoxes is the equivalent.
template <int Dim, class Boxes>
void add_boxes(const SparseGrid<Dim>& grid, const Particles<Dim>& particles, const Boxes& boxes) {
  parallel_for(boxes.groups(), [&](std::size_t g) {
    const auto here = boxes.group(g);
    for (std::size_t k = 0; k < here.tiles(); ++k) {
      for (const TileBatch<Dim>& batch : grid.batches(here.tile(k))) {
        const auto spans = boxes.spans(here, particles, batch);
        for (std::size_t lane = 0; lane < batch.count; ++lane) {
          const auto box = boxes.box(particles, batch.particle[lane], spans, lane);
          boxes.for_places(here, box, [&](std::size_t place, const auto& share) THAWSLIDE_INLINE_LAMBDA {
            boxes.add(box, share, *boxes.part(here, place));
          });
        }
      }
    }
  });
}

}  // namespace thawslide::mpm
