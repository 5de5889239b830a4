// Sums over the boxes of particles (mpm/box_sums.hpp) on a device, one thread group per group of tiles. For each chunk
// of particles, one thread per particle finds its box; then one thread per place adds the boxes above it in order.
#pragma once

#include "device/tile_tables.hpp"
#include "mpm/particle_view.hpp"
#include "mpm/scalar_index.hpp"

namespace thawslide::device {

template <int Dim, class Boxes>
struct AddBoxes {
  using Box = typename Boxes::Box;
  static constexpr std::size_t at_a_time = 128, bytes = at_a_time * sizeof(Box);

  TileTables<Dim> tables;
  mpm::ParticleView<Dim> particles;
  Boxes boxes;

  template <class Group>
  THAWSLIDE_HD void operator()(Group& group, std::size_t g) const {
    constexpr auto nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);
    auto* chunk = reinterpret_cast<Box*>(group.shared());
    const auto here = boxes.group(g);
    for (std::size_t t = 0; t < here.tiles(); ++t) {
      const std::size_t end = tables.first_of_cell[(here.tile(t) + 1) * nodes];
      for (std::size_t first = tables.first_of_cell[here.tile(t) * nodes]; first < end; first += at_a_time) {
        const std::size_t count = end - first < at_a_time ? end - first : at_a_time;
        group.each(count, [this, here, first, chunk](std::size_t k) {
          const std::uint32_t p = tables.order[first + k];
          chunk[k] = boxes.box(particles, p, boxes.spans(here, particles, mpm::ScalarIndex{{p}}), 0);
        });
        group.barrier();
        group.each(here.places(), [this, here, chunk, count](std::size_t place) {
          if (auto* part = boxes.part(here, place)) {
            auto sum = *part;
            for (std::size_t k = 0; k < count; ++k) {
              if (const auto share = boxes.share(here, chunk[k], place)) {
                boxes.add(chunk[k], share, sum);
              }
            }
            *part = sum;
          }
        });
        group.barrier();
      }
    }
  }
};

template <int Dim, class Backend, class Boxes>
void add_boxes(Backend& backend, const TileTables<Dim>& tables, const mpm::ParticleView<Dim>& particles,
               const Boxes& boxes) {
  using Add = AddBoxes<Dim, Boxes>;
  backend.for_groups(boxes.groups(), Add::at_a_time, Add::bytes, Add{tables, particles, boxes});
}

}  // namespace thawslide::device
