// Kernels that find cells, tiles and blocks (device/cells.hpp), one thread per item.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "base/portability.hpp"
#include "device/tile_tables.hpp"
#include "mpm/mapping.hpp"
#include "mpm/particle_view.hpp"

namespace thawslide::device {

// In the same layer.
template <int Dim>
THAWSLIDE_HD std::uint64_t key_of_neighbour(std::uint64_t key, std::size_t direction) {
  using T = mpm::Tile<Dim>;
  typename T::Index tile = T::index(key);
  for (std::size_t a = 0; a < Dim; ++a) {
    tile[a] += static_cast<int>(direction % 3) - 1;
    direction /= 3;
  }
  return T::in_layer(T::key(tile), T::layer(key));
}

// Computes the key of each particle, by id. Sets any_changed if a key differs from the last one.
template <int Dim>
struct FindKey {
  mpm::ParticleView<Dim> particles;
  const std::uint32_t* by_id;
  double inverse_cell;
  mpm::Mapping mapping;
  const std::uint8_t* layer_of_body;  // null: all bodies share nodes
  std::uint64_t* keys;
  std::uint32_t* any_changed;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    using T = mpm::Tile<Dim>;
    const std::uint32_t particle = by_id[k];
    typename T::Index node{}, tile{};
    for (std::size_t a = 0; a < Dim; ++a) {
      const double in_cells =
          mapping.template coordinate<Dim>(particles, mpm::ScalarIndex{{particle}}, static_cast<int>(a)) * inverse_cell;
      node[a] = static_cast<int>(std::floor(in_cells + 0.5));
    }
    int local = 0;
    T::split(node, tile, local);
    const std::uint64_t layer =
        layer_of_body != nullptr ? layer_of_body[static_cast<std::size_t>(particles.body(particle))] : 0;
    const std::uint64_t key = (T::in_layer(T::key(tile), layer) << T::node_bits) | static_cast<std::uint64_t>(local);
    if (keys[k] != key) {
      keys[k] = key;
      *any_changed = 1;  // benign race: all threads write the same value
    }
  }
};

struct FlagDifference {
  const std::uint64_t *a, *b;
  std::uint32_t* any_differs;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    if (a[k] != b[k]) {
      *any_differs = 1;
    }
  }
};

template <int Dim>
struct FirstOfCell {
  const std::uint64_t* keys;
  std::size_t particles;
  const std::uint64_t* tile_keys;
  const std::uint32_t* first_of_tile;
  std::size_t tiles;
  std::uint32_t* first_of_cell;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    using T = mpm::Tile<Dim>;
    const std::size_t tile = k / static_cast<std::size_t>(T::nodes);
    if (tile == tiles) {
      first_of_cell[k] = static_cast<std::uint32_t>(particles);
      return;
    }
    const std::size_t last = tile + 1 < tiles ? first_of_tile[tile + 1] : particles;
    const std::uint64_t key = (tile_keys[tile] << T::node_bits) | (k % static_cast<std::size_t>(T::nodes));
    first_of_cell[k] = static_cast<std::uint32_t>(exec::first_not_below(keys, first_of_tile[tile], last, key));
  }
};

// Keys of the blocks around tiles, with duplicates: one entry per tile and block.
template <int Dim>
struct ListNeighbours {
  const std::uint64_t* tile_keys;
  std::uint64_t* keys;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    constexpr auto stencil = static_cast<std::size_t>(mpm::Tile<Dim>::stencil);
    keys[k] = key_of_neighbour<Dim>(tile_keys[k / stencil], k % stencil);
  }
};

// Places, in the list `to`, of the 3^Dim neighbours of each key of the list `from`.
template <int Dim>
struct FindNeighbours {
  const std::uint64_t *from, *to;
  std::size_t count;  // of `to`
  std::int32_t* indices;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    constexpr auto stencil = static_cast<std::size_t>(mpm::Tile<Dim>::stencil);
    indices[k] = exec::index_of_key(to, count, key_of_neighbour<Dim>(from[k / stencil], k % stencil));
  }
};

using exec::Fill;

// Keep copies one sum; Add adds it to another sum.
template <class Sum>
struct Keep {
  const Sum* from;
  Sum* to;

  THAWSLIDE_HD void operator()(std::size_t /*k*/) const { *to = *from; }
};
template <class Sum>
struct Add {
  const Sum* from;
  Sum* to;

  THAWSLIDE_HD void operator()(std::size_t /*k*/) const { *to += *from; }
};

struct Count {
  std::uint32_t* numbers;

  THAWSLIDE_HD void operator()(std::size_t k) const { numbers[k] = static_cast<std::uint32_t>(k); }
};

}  // namespace thawslide::device
