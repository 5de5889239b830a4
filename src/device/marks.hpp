// Marks of tiles and blocks, to restrict passes to them.
#pragma once

#include "device/cell_kernels.hpp"
#include "device/tile_tables.hpp"
#include "exec/array.hpp"

namespace thawslide::device {

// Marks the tiles with a particle that meets a condition (band/tile_conditions.hpp), or near a node that does. One
// thread group per tile.
template <class Condition, int Dim>
struct MarkTiles {
  using T = mpm::Tile<Dim>;
  TileTables<Dim> tables;
  mpm::ParticleView<Dim> particles;
  const double* records;  // of nodes, that the condition reads
  Condition condition;
  std::uint8_t* marks;

  template <class Group>
  THAWSLIDE_HD void operator()(Group& group, std::size_t tile) const {
    constexpr auto nodes = static_cast<std::size_t>(T::nodes), stencil = static_cast<std::size_t>(T::stencil);
    const std::size_t first = tables.first_of_cell[tile * nodes], last = tables.first_of_cell[(tile + 1) * nodes];
    group.each(1, [this, tile](std::size_t /*k*/) { marks[tile] = 0; });
    group.barrier();
    using Name = typename Condition::Reads;
    if constexpr (!std::is_void_v<Name>) {
      group.each(static_cast<std::size_t>(T::patch_nodes), [this, tile](std::size_t k) {
        constexpr std::size_t size = mpm::record_size(mpm::components_of<Name, Dim>);
        const NodeInBlock<Dim> found = node_in_block<Dim>(k);
        const std::int32_t block = tables.blocks_about_tile[tile * stencil + found.direction];
        if (condition.of_node(records + (static_cast<std::size_t>(block) * nodes + found.node) * size)) {
          marks[tile] = 1;  // benign race: all threads write the same value
        }
      });
    }
    group.each(last - first, [this, tile, first](std::size_t k) {
      if (condition.of_particles(particles, mpm::ScalarIndex{{tables.order[first + k]}})) {
        marks[tile] = 1;
      }
    });
  }
};

// Marks the blocks whose nodes particles of marked tiles may reach.
template <int Dim>
struct MarkBlocks {
  TileTables<Dim> tables;
  const std::uint8_t* tiles;
  std::uint8_t* blocks;

  THAWSLIDE_HD void operator()(std::size_t block) const {
    constexpr auto stencil = static_cast<std::size_t>(mpm::Tile<Dim>::stencil);
    std::uint8_t any = 0;
    for (std::size_t d = 0; d < stencil; ++d) {
      const std::int32_t tile = tables.tiles_about_block[block * stencil + d];
      any = tile != absent && tiles[tile] != 0 ? 1 : any;
    }
    blocks[block] = any;
  }
};

// Marks the tiles whose particles reach nodes of marked blocks, and sets any_marked if there are any.
template <int Dim>
struct MarkTilesAbout {
  TileTables<Dim> tables;
  const std::uint8_t* blocks;
  std::uint8_t* tiles;
  std::uint32_t* any_marked;

  THAWSLIDE_HD void operator()(std::size_t tile) const {
    constexpr auto stencil = static_cast<std::size_t>(mpm::Tile<Dim>::stencil);
    std::uint8_t any = 0;
    for (std::size_t d = 0; d < stencil; ++d) {
      any = blocks[tables.blocks_about_tile[tile * stencil + d]] != 0 ? 1 : any;
    }
    tiles[tile] = any;
    if (any != 0) {
      *any_marked = 1;  // benign race: all threads write the same value
    }
  }
};

// Tile filter of a pass over marked tiles.
struct MarkedTiles {
  const std::uint8_t* marks;

  THAWSLIDE_HD bool operator()(std::size_t tile) const { return marks[tile] != 0; }
  THAWSLIDE_HD bool operator()(std::size_t /*tile*/, std::size_t /*cell*/) const { return true; }
};

template <class Backend, int Dim>
class Marks {
 public:
  explicit Marks(Backend& backend) : backend_(backend) {}

  // Call after blocks have changed.
  void resize(const TileTables<Dim>& tables) {
    tiles_.resize(tables.tiles);
    blocks_.resize(tables.blocks);
  }

  template <class Condition>
  void mark_tiles(const TileTables<Dim>& tables, const mpm::ParticleView<Dim>& particles, const double* records,
                  const Condition& condition) {
    constexpr std::size_t threads = 128;
    backend_.for_groups(tables.tiles, threads, 0,
                        MarkTiles<Condition, Dim>{tables, particles, records, condition, tiles_.data()});
  }
  void mark_blocks(const TileTables<Dim>& tables) {
    backend_.for_each(tables.blocks, MarkBlocks<Dim>{tables, tiles_.data(), blocks_.data()});
  }
  // Marks the tiles around marked blocks. Returns false if there are none.
  bool mark_tiles_about(const TileTables<Dim>& tables) {
    backend_.for_each(1, Fill<std::uint32_t>{any_.data(), 0});
    backend_.for_each(tables.tiles, MarkTilesAbout<Dim>{tables, blocks_.data(), tiles_.data(), any_.data()});
    return any_.get(0) != 0;
  }

  [[nodiscard]] MarkedTiles tiles() const { return MarkedTiles{tiles_.data()}; }
  [[nodiscard]] const std::uint8_t* blocks() const { return blocks_.data(); }

 private:
  Backend& backend_;
  exec::Array<std::uint8_t, Backend> tiles_{backend_}, blocks_{backend_};
  exec::Array<std::uint32_t, Backend> any_{backend_, 1};
};

}  // namespace thawslide::device
