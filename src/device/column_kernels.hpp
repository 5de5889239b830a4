// Contributions of particles to the columns of the sliding mass (band/slide_columns.hpp) on a device, and their load.
#pragma once

#include "band/columns_of_tile.hpp"
#include "device/tile_tables.hpp"
#include "mpm/particle_view.hpp"

namespace thawslide::device {

// Contributions of each tile's particles to the columns that it overlaps, one thread group per tile. For each chunk of
// particles, one thread per particle finds the overlaps of its box; then one thread per column adds the boxes in order.
template <int Dim>
struct SumInTile {
  static constexpr std::size_t at_a_time = 128, indices = band::columns_per_tile<Dim>;

  TileTables<Dim> tables;
  mpm::ParticleView<Dim> particles;
  mpm::SizesOfBodies sizes;  // half sizes of particles [m]
  double cell;
  mpm::Mapping mapping;
  band::ColumnPart<Dim>* parts;  // by tile and place

  struct Box {
    double volume, mass, top;
    band::Overlaps<Dim, double> along;
  };
  static constexpr std::size_t bytes = at_a_time * sizeof(Box);

  template <class Group>
  THAWSLIDE_HD void operator()(Group& group, std::size_t tile) const {
    constexpr auto nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);
    auto* boxes = reinterpret_cast<Box*>(group.shared());
    const std::size_t end = tables.first_of_cell[(tile + 1) * nodes];
    for (std::size_t first = tables.first_of_cell[tile * nodes], begin = first; first < end; first += at_a_time) {
      const std::size_t here = end - first < at_a_time ? end - first : at_a_time;
      group.each(here, [this, tile, first, boxes](std::size_t k) { boxes[k] = box_of(tile, tables.order[first + k]); });
      group.barrier();
      group.each(indices, [this, tile, boxes, here, is_first = first == begin](std::size_t index) {
        band::ColumnPart<Dim>& part = parts[tile * indices + index];
        part = sum_boxes(boxes, here, index, is_first ? band::ColumnPart<Dim>{} : part);
      });
      group.barrier();
    }
  }

 private:
  [[nodiscard]] THAWSLIDE_HD Box box_of(std::size_t tile, std::uint32_t particle) const {
    const mpm::ScalarIndex at{{particle}};
    return {
        particles.volume(particle), particles.mass(particle),
        mapping.template coordinate<Dim>(particles, at, Dim - 1) + sizes.of(particles, at).half,
        band::overlaps<Dim>(band::first_cell_of<Dim>(tables.tile_keys[tile]), cell, 1.0 / cell, sizes, particles, at)};
  }

  [[nodiscard]] THAWSLIDE_HD static band::ColumnPart<Dim> sum_boxes(const Box* boxes, std::size_t count,
                                                                    std::size_t index, band::ColumnPart<Dim> sum) {
    for (std::size_t k = 0; k < count; ++k) {
      const Box& box = boxes[k];
      band::for_columns<Dim>(box.along, [&](const auto& side, double at, double fraction) {
        if (!(fraction > 0.0) || static_cast<std::size_t>(at) != index) {
          return;
        }
        const double volume = fraction * box.volume;
        if (volume > 0.0) {
          sum.column_mass += {volume, box.top};
        }
        sum.extent += band::extent_in_column<Dim>(box.along, side, 0);
        sum.mass += fraction * box.mass;
      });
    }
    return sum;
  }
};

// Normal load of a particle, from columns that hold the load per depth in place of the cosine.
template <class Columns>
struct AddPressureLoad {
  using Reads = mpm::RecordList<>;
  using Adds = mpm::RecordList<>;
  using Totals = mpm::NoTotals;

  struct InTile {
    typename Columns::OfTile columns;

    template <class Particles, class At, class Seen, class Scatter>
    THAWSLIDE_HD void operator()(Particles& particles, const At& at, const Seen& /*seen*/, Scatter& /*added*/,
                                 Totals& /*totals*/) const {
      band::update_load(particles, at.particle[0], columns.flow_depth(particles, at));
    }
  };

  Columns columns;  // by tile

  [[nodiscard]] THAWSLIDE_HD InTile in_tile(std::size_t tile) const { return InTile{columns.of_tile(tile)}; }
};

}  // namespace thawslide::device
