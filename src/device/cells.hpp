// Cells, tiles and blocks of particles, and their canonical order, as in mpm/sparse_grid.hpp, in device memory. The
// tables are rebuilt when the nearest node of any particle changes.
#pragma once

#include <utility>

#include "device/cell_kernels.hpp"
#include "device/tile_tables.hpp"
#include "exec/array.hpp"
#include "exec/key_lists.hpp"

namespace thawslide::device {

template <class Backend, int Dim>
class Cells {
  using T = mpm::Tile<Dim>;
  static constexpr std::size_t nodes = static_cast<std::size_t>(T::nodes);
  static constexpr std::size_t stencil = static_cast<std::size_t>(T::stencil);
  static constexpr std::uint64_t no_key = ~std::uint64_t{0};

 public:
  // cell: mesh size [m].
  Cells(Backend& backend, double cell, const mpm::Mapping& mapping)
      : backend_(backend), inverse_cell_(1.0 / cell), mapping_(mapping) {}

  // Moves bodies to other layers of the grid, from the next update on.
  void set_layers(std::vector<std::uint8_t> layer_of_body) {
    if (layer_of_body != layers_) {
      layer_of_body_.set(layer_of_body);
      layers_ = std::move(layer_of_body);
    }
  }
  // Updates the tables to the particle positions. by_id: particles by ascending id. count: number of particles.
  void update(const mpm::ParticleView<Dim>& particles, const std::uint32_t* by_id, std::size_t count) {
    blocks_changed_ = false;
    if (count != keys_by_id_.size()) {
      keys_by_id_.resize(count);
      fill(keys_by_id_, no_key);
    }
    fill(mark_, std::uint32_t{0});
    backend_.for_each(count, FindKey<Dim>{particles, by_id, inverse_cell_, mapping_, layer_of_body_.data(),
                                          keys_by_id_.data(), mark_.data()});
    if (mark_.get(0) == 0) {
      return;
    }
    keys_.resize(count);
    order_.resize(count);
    backend_.sort(keys_by_id_.data(), by_id, keys_.data(), order_.data(), count);
    former_tile_keys_.swap(tile_keys_);
    first_.find(keys_, T::node_bits, tile_keys_, &first_of_tile_);
    if (tiles_changed()) {
      list_blocks();
      blocks_changed_ = true;
    }
    first_of_cell_.resize(tile_keys_.size() * nodes + 1);
    backend_.for_each(first_of_cell_.size(),
                      FirstOfCell<Dim>{keys_.data(), count, tile_keys_.data(), first_of_tile_.data(), tile_keys_.size(),
                                       first_of_cell_.data()});
  }

  // Call after particles have been sorted in memory into canonical order.
  void store_memory_order() { backend_.for_each(order_.size(), Count{order_.data()}); }

  [[nodiscard]] TileTables<Dim> tables() const {
    return {keys_.size(),
            tile_keys_.size(),
            block_keys_.size(),
            order_.data(),
            keys_.data(),
            tile_keys_.data(),
            block_keys_.data(),
            first_of_cell_.data(),
            blocks_about_tile_.data(),
            tiles_about_block_.data(),
            blocks_about_block_.data()};
  }
  [[nodiscard]] std::vector<std::uint64_t> block_keys() const { return block_keys_.get(); }
  [[nodiscard]] std::vector<std::uint64_t> tile_keys() const { return tile_keys_.get(); }
  // True if the last update changed the blocks, and hence their numbers.
  [[nodiscard]] bool blocks_changed() const { return blocks_changed_; }

 private:
  template <class Number>
  void fill(exec::Array<Number, Backend>& numbers, Number number) {
    backend_.for_each(numbers.size(), Fill<Number>{numbers.data(), number});
  }

  bool tiles_changed() {
    if (former_tile_keys_.size() != tile_keys_.size()) {
      return true;
    }
    fill(mark_, std::uint32_t{0});
    backend_.for_each(tile_keys_.size(), FlagDifference{tile_keys_.data(), former_tile_keys_.data(), mark_.data()});
    return mark_.get(0) != 0;
  }

  void list_blocks() {
    const std::size_t tiles = tile_keys_.size();
    unsorted_.resize(tiles * stencil);
    neighbour_keys_.resize(tiles * stencil);
    backend_.for_each(tiles * stencil, ListNeighbours<Dim>{tile_keys_.data(), unsorted_.data()});
    backend_.sort(unsorted_.data(), neighbour_keys_.data(), tiles * stencil);
    first_.find(neighbour_keys_, 0, block_keys_, nullptr);
    find_neighbours(tile_keys_, block_keys_, blocks_about_tile_);
    find_neighbours(block_keys_, tile_keys_, tiles_about_block_);
    find_neighbours(block_keys_, block_keys_, blocks_about_block_);
  }

  void find_neighbours(const exec::Array<std::uint64_t, Backend>& from, const exec::Array<std::uint64_t, Backend>& to,
                       exec::Array<std::int32_t, Backend>& indices) {
    indices.resize(from.size() * stencil);
    backend_.for_each(indices.size(), FindNeighbours<Dim>{from.data(), to.data(), to.size(), indices.data()});
  }

  Backend& backend_;
  double inverse_cell_;
  mpm::Mapping mapping_;
  std::vector<std::uint8_t> layers_;                            // by body; empty: all share nodes
  exec::Array<std::uint8_t, Backend> layer_of_body_{backend_};  // the same
  exec::Array<std::uint64_t, Backend> keys_by_id_{backend_}, keys_{backend_};
  exec::Array<std::uint32_t, Backend> order_{backend_}, mark_{backend_, 1};
  exec::Array<std::uint64_t, Backend> tile_keys_{backend_}, former_tile_keys_{backend_}, block_keys_{backend_};
  exec::Array<std::uint64_t, Backend> unsorted_{backend_}, neighbour_keys_{backend_};
  exec::Array<std::uint32_t, Backend> first_of_tile_{backend_}, first_of_cell_{backend_};
  exec::Array<std::int32_t, Backend> blocks_about_tile_{backend_}, tiles_about_block_{backend_};
  exec::Array<std::int32_t, Backend> blocks_about_block_{backend_};
  exec::UniqueKeys<Backend> first_{backend_};
  bool blocks_changed_ = true;
};

}  // namespace thawslide::device
