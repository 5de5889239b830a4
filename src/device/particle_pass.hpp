// Particle pass (mpm/particle_pass.hpp) on a device, one thread group per tile. The threads load the records around the
// tile. For each chunk of particles, one thread per particle runs the kernels; one thread per node of a cell adds the
// contributions of the cell's particles in order; one thread per number adds those of the cells in order to the tile's
// patch. Min-reduced components use the minimum instead. Barriers separate these phases. No two threads write the same
// number, and sums have the order of the CPU: results are bitwise identical.
#pragma once

#include <limits>

#include "device/shared_memory_layout.hpp"
#include "device/tile_tables.hpp"

namespace thawslide::device {

// Tile filter that accepts all tiles and all their particles.
struct AllTiles {
  THAWSLIDE_HD bool operator()(std::size_t /*tile*/) const { return true; }
  THAWSLIDE_HD bool operator()(std::size_t /*tile*/, std::size_t /*cell*/) const { return true; }
};

// Arguments of a pass except its kernels. TileFilter: called with a tile, or with a tile and one of its cells.
template <class Weights, class TileFilter, int Dim>
struct PassOver {
  TileTables<Dim> tables;
  mpm::ParticleView<Dim> particles;
  Weights weights;
  TileFilter accepts;
  double cell;
  mpm::Mapping mapping;
};

template <class Over, class Reads, class Adds, int Dim, class... Kernels>
struct ParticlePass;
template <class Over, class... Reads, class... Adds, int Dim, class... Kernels>
struct ParticlePass<Over, mpm::RecordList<Reads...>, mpm::RecordList<Adds...>, Dim, Kernels...> {
  using MemoryLayout = SharedMemoryLayout<mpm::RecordList<Reads...>, mpm::RecordList<Adds...>, Dim, Kernels...>;
  using T = mpm::Tile<Dim>;
  using Sums = SumsOf<Kernels...>;
  static constexpr auto nodes = static_cast<std::size_t>(T::nodes);
  static constexpr auto patch_nodes = static_cast<std::size_t>(T::patch_nodes);
  static constexpr std::size_t cell_nodes = MemoryLayout::cell_nodes, size = MemoryLayout::size;
  static constexpr bool adds = sizeof...(Adds) > 0, adds_up = MemoryLayout::adds_up;

  Over over;
  mpm::ByName<mpm::Named<Reads, const double*>...> records;
  double* patches;  // of the record that is added to
  Sums* sums;       // by tile
  mpm::ByName<mpm::Named<Kernels, Kernels>...> kernels;

  // Particles [first, last) in canonical order, from `cells` cells beginning at `cell`.
  struct Chunk {
    std::size_t tile, first, last, cell, cells, number;
  };

  // Layers of cells, along the last axis, that a chunk touches. The nodes that they reach span two more layers.
  struct Layers {
    std::size_t first, end;
  };

  template <class Group>
  THAWSLIDE_HD void operator()(Group& group, std::size_t tile) const {
    const MemoryLayout memory(group.shared());
    const std::size_t end = first_of_cell(tile, nodes);
    if (!over.accepts(tile)) {
      group.each(1, [this, tile](std::size_t /*k*/) { sums[tile] = {}; });
      return;
    }
    (this->template fetch<Reads>(group, memory, tile), ...);
    prepare(group, memory, tile);
    group.barrier();
    Chunk chunk{tile, first_of_cell(tile, 0), 0, 0, 0, 0};
    for (; chunk.first < end; chunk.first = chunk.last, ++chunk.number) {
      while (first_of_cell(tile, chunk.cell + 1) <= chunk.first) {
        ++chunk.cell;
      }
      chunk.cells = chunk.cell + MemoryLayout::most_cells < nodes ? MemoryLayout::most_cells : nodes - chunk.cell;
      const std::size_t of_cells = first_of_cell(tile, chunk.cell + chunk.cells);
      chunk.last = chunk.first + MemoryLayout::capacity < of_cells ? chunk.first + MemoryLayout::capacity : of_cells;
      group.each(chunk.last - chunk.first, [this, chunk, memory](std::size_t k) { visit(chunk, memory, k); });
      group.barrier();
      if constexpr (adds_up) {
        group.each(1, [chunk, memory](std::size_t /*k*/) { add_up(chunk, memory); });
      }
      (this->template add<Adds>(group, memory, chunk), ...);
      if constexpr (!adds && adds_up) {
        group.barrier();
      }
    }
    leave(group, memory, tile);
  }

 private:
  [[nodiscard]] THAWSLIDE_HD std::size_t first_of_cell(std::size_t tile, std::size_t cell) const {
    return over.tables.first_of_cell[tile * nodes + cell];
  }

  // Loads a record of the patch into shared memory. One thread per number.
  template <class Name, class Group>
  THAWSLIDE_HD void fetch(Group& group, const MemoryLayout& memory, std::size_t tile) const {
    constexpr std::size_t of_record = mpm::record_size(mpm::components_of<Name, Dim>);
    group.each(patch_nodes * of_record, [this, memory, tile](std::size_t k) {
      const NodeInBlock<Dim> found = node_in_block<Dim>(k / of_record);
      const std::int32_t block =
          over.tables.blocks_about_tile[tile * static_cast<std::size_t>(T::stencil) + found.direction];
      memory.template read<Name>()[k] =
          records
              .template of<Name>()[(static_cast<std::size_t>(block) * nodes + found.node) * of_record + k % of_record];
    });
  }

  // Initializes the patch. A record that aliases another one continues the sums of an earlier pass.
  template <class Group>
  THAWSLIDE_HD void prepare(Group& group, const MemoryLayout& memory, std::size_t tile) const {
    if constexpr (adds) {
      group.each(patch_nodes * size, [this, memory, tile](std::size_t k) {
        memory.patch()[k] = MemoryLayout::accumulates ? patches[tile * patch_nodes * size + k] : 0.0;
        (raise<Adds>(k % size, memory.patch()[k]), ...);
      });
    }
    if constexpr (adds_up) {
      group.each(1, [memory](std::size_t /*k*/) { *memory.sums() = {}; });
    }
  }
  template <class Group>
  THAWSLIDE_HD void leave(Group& group, const MemoryLayout& memory, std::size_t tile) const {
    if constexpr (adds) {
      group.barrier();
      group.each(patch_nodes * size,
                 [this, memory, tile](std::size_t k) { patches[tile * patch_nodes * size + k] = memory.patch()[k]; });
    }
    if constexpr (adds_up) {
      group.each(1, [this, memory, tile](std::size_t /*k*/) { sums[tile] = *memory.sums(); });
    }
  }

  template <class Name>
  static constexpr std::size_t first_component =
      mpm::IsMinReduced<Name> ? mpm::part_of<Name, Dim>.from : mpm::first_in_register<Name, Dim>;
  // Initial value of a sum or a minimum.
  template <class Name>
  static constexpr double start = mpm::IsMinReduced<Name> ? std::numeric_limits<double>::max() : 0.0;

  // Initializes min-reduced components to the largest number.
  template <class Name>
  THAWSLIDE_HD static void raise(std::size_t component, double& number) {
    if (mpm::IsMinReduced<Name> && component >= first_component<Name> &&
        component < first_component<Name> + mpm::scatter_size<Name, Dim>) {
      number = start<Name>;
    }
  }

  // Runs the kernels. One thread per particle.
  THAWSLIDE_HD void visit(const Chunk& chunk, const MemoryLayout& memory, std::size_t k) const {
    auto& slot = memory.slots()[k];
    slot.sums = {};
    const TileTables<Dim>& tables = over.tables;
    const std::size_t index = chunk.first + k;
    const std::size_t node = tables.keys[index] & (nodes - 1), lowest = lowest_about<Dim>(node);
    if (!over.accepts(chunk.tile, node)) {
      return;
    }
    const mpm::ScalarIndex at{{tables.order[index]}};
    const double inverse_cell = 1.0 / over.cell;
    const typename T::Index nearest = T::node(T::index(tables.tile_keys[chunk.tile]), static_cast<int>(node));
    mpm::OneGridPosition<Dim> from_node{{}, lowest, {}};
    for (std::size_t a = 0; a < Dim; ++a) {
      const int axis = static_cast<int>(a);
      from_node.offset[axis] = over.mapping.template coordinate<Dim>(over.particles, at, axis) * inverse_cell -
                               static_cast<double>(nearest[a]);
      from_node.at_side[a] = over.weights.template at_side<Dim>(a, nearest[a]);
    }
    mpm::OneWeights<Dim> weights(over.mapping, over.particles, at);
    over.weights.set(weights, from_node, over.particles, at, over.cell, inverse_cell);
    const auto patches_read = memory.patches_read();
    const mpm::ScalarGather<mpm::OneWeights<Dim>, typename MemoryLayout::PatchesRead> seen{weights, patches_read};
    typename MemoryLayout::Carried carried{};
    Sums of_particle{};
    mpm::ParticleView<Dim> particles = over.particles;
    (run(kernel_of(kernels.template of<Kernels>(), chunk.tile), particles, at, seen, carried,
         of_particle.template of<Kernels>()),
     ...);
    slot.sums = of_particle;
    (mpm::map_fluxes<Adds>(weights, carried.template of<Adds>()), ...);
    slot.carried = carried;
    slot.keep(weights);
  }
  template <class Kernel, class Seen, class Sum>
  THAWSLIDE_HD static void run(const Kernel& kernel, mpm::ParticleView<Dim>& particles, const mpm::ScalarIndex& at,
                               const Seen& seen, typename MemoryLayout::Carried& carried, Sum& sum) {
    kernel(particles, at, seen, carried, sum);
  }

  THAWSLIDE_HD static void add_up(const Chunk& chunk, const MemoryLayout& memory) {
    Sums sum = *memory.sums();
    for (std::size_t k = 0; k < chunk.last - chunk.first; ++k) {
      sum += memory.slots()[k].sums;
    }
    *memory.sums() = sum;
  }

  // Particles of a cell that belong to a chunk.
  struct CellPart {
    std::size_t first, last;
    bool begins, ends;
    [[nodiscard]] THAWSLIDE_HD bool is_present() const { return first < last; }
  };
  [[nodiscard]] THAWSLIDE_HD CellPart part_of_cell(const Chunk& chunk, std::size_t k) const {
    const std::size_t cell = chunk.cell + k;
    const std::size_t from = first_of_cell(chunk.tile, cell), to = first_of_cell(chunk.tile, cell + 1);
    CellPart part{from < chunk.first ? chunk.first : from, to < chunk.last ? to : chunk.last, from >= chunk.first,
                  to <= chunk.last};
    if (!part.is_present() || !over.accepts(chunk.tile, cell)) {
      part.last = part.first;
    }
    return part;
  }

  // Adds contributions with one thread per node of a cell, then one thread per number of the patch.
  template <class Name, class Group>
  THAWSLIDE_HD void add(Group& group, const MemoryLayout& memory, const Chunk& chunk) const {
    constexpr std::size_t carried = mpm::scatter_size<Name, Dim>;
    if (!MemoryLayout::template is_first<Name>()) {
      group.barrier();
    }
    group.each(chunk.cells * cell_nodes, [this, memory, chunk](std::size_t k) { sum_in_cell<Name>(memory, chunk, k); });
    group.barrier();
    const Layers layers = layers_of(chunk);
    group.each((layers.end - layers.first + 2) * layer_nodes * carried, [this, memory, chunk, layers](std::size_t k) {
      add_cells<Name>(memory, chunk, layers, layers.first * layer_nodes + k / carried, k % carried);
    });
  }

  template <class Name>
  THAWSLIDE_HD void sum_in_cell(const MemoryLayout& memory, const Chunk& chunk, std::size_t k) const {
    constexpr std::size_t carried = mpm::scatter_size<Name, Dim>;
    const CellPart part = part_of_cell(chunk, k / cell_nodes);
    if (!part.is_present()) {
      return;
    }
    const std::size_t node = k % cell_nodes;
    const std::array<std::size_t, 3> along{node % 3, node / 3 % 3, node / 9};
    const double* open = memory.template open<Name>(chunk.number) + node * carried;
    double sum[carried];
    for (std::size_t c = 0; c < carried; ++c) {
      sum[c] = part.begins ? start<Name> : open[c];
    }
    for (std::size_t p = part.first; p < part.last; ++p) {
      const auto& slot = memory.slots()[p - chunk.first];
      const mpm::OneAtNode<Dim> at = mpm::at_node<Dim>(slot.template stencil<Name>(), along);
      const auto& brought = slot.carried.template of<Name>();
      for (std::size_t c = 0; c < carried && at.is_seen; ++c) {
        sum[c] = mpm::add_particle(at, brought, c, sum[c]);
      }
    }
    double* to =
        part.ends ? memory.cell_sums() + k * carried : memory.template open<Name>(chunk.number + 1) + node * carried;
    for (std::size_t c = 0; c < carried; ++c) {
      to[c] = sum[c];
    }
  }

  template <class Name>
  THAWSLIDE_HD void add_cells(const MemoryLayout& memory, const Chunk& chunk, const Layers& layers, std::size_t node,
                              std::size_t component) const {
    constexpr std::size_t carried = mpm::scatter_size<Name, Dim>;
    double& number = memory.patch()[node * size + first_component<Name> + component];
    for_cells_that_see(layers, node, [&](std::size_t cell, std::size_t node_of_cell) {
      const std::size_t k = cell - chunk.cell;
      if (cell < chunk.cell || k >= chunk.cells) {
        return;
      }
      const CellPart part = part_of_cell(chunk, k);
      if (part.is_present() && part.ends) {
        const double brought = memory.cell_sums()[(k * cell_nodes + node_of_cell) * carried + component];
        number = mpm::IsMinReduced<Name> ? min(number, brought) : number + brought;
      }
    });
  }

  static constexpr std::size_t layer_nodes = patch_nodes / static_cast<std::size_t>(T::patch_edge);
  THAWSLIDE_HD static Layers layers_of(const Chunk& chunk) {
    constexpr std::size_t layer_cells = nodes / static_cast<std::size_t>(T::edge);
    return {chunk.cell / layer_cells, (chunk.cell + chunk.cells - 1) / layer_cells + 1};
  }

  // Calls visit(cell, node of the cell), in order, for the cells of the given layers that reach a node of the patch.
  template <class Visit>
  THAWSLIDE_HD static void for_cells_that_see(const Layers& layers, std::size_t node, const Visit& visit) {
    constexpr auto edge = static_cast<std::size_t>(T::edge), patch_edge = static_cast<std::size_t>(T::patch_edge);
    const std::size_t at[3] = {node % patch_edge, node / patch_edge % patch_edge, node / patch_edge / patch_edge};
    std::size_t from[3] = {0, 0, 0}, to[3] = {1, 1, 1};
    for (int a = 0; a < Dim; ++a) {
      from[a] = at[a] < 2 ? 0 : at[a] - 2;
      to[a] = at[a] + 1 < edge ? at[a] + 1 : edge;
    }
    from[Dim - 1] = from[Dim - 1] < layers.first ? layers.first : from[Dim - 1];
    to[Dim - 1] = to[Dim - 1] < layers.end ? to[Dim - 1] : layers.end;
    for (std::size_t z = from[2]; z < to[2]; ++z) {
      for (std::size_t y = from[1]; y < to[1]; ++y) {
        for (std::size_t x = from[0]; x < to[0]; ++x) {
          visit((z * edge + y) * edge + x, ((at[2] - z) * 3 + at[1] - y) * 3 + at[0] - x);
        }
      }
    }
  }
};

}  // namespace thawslide::device
