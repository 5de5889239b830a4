// Order, tiles and blocks as computed by a device (device/cells.hpp), compared with those of SparseGrid.
#include "device/cells.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "device/host_backend.hpp"
#include "device/particles.hpp"
#include "mpm/sparse_grid.hpp"

namespace thawslide::mpm {
namespace {

using device::Host, device::ThreadOrder;

// Particles at positive and negative positions, many in one cell, with ids independent of their order in memory.
template <int Dim>
void scatter(std::size_t count, Particles<Dim>& particles) {
  std::mt19937 random(3);
  particles.resize(count);
  for (std::size_t p = 0; p < count; ++p) {
    particles.id(p) = static_cast<std::int64_t>((p * 7919) % count) + 5;
    particles.body(p) = static_cast<std::int32_t>(p % 2);
    for (int a = 0; a < Dim; ++a) {
      particles.position(p, a) = std::normal_distribution<double>(-2.0, 6.0)(random);
    }
  }
}

template <class Number>
void expect_the_same(const Number* found, const std::vector<Number>& expected, const char* what) {
  EXPECT_EQ(std::vector<Number>(found, found + expected.size()), expected) << what;
}

template <int Dim>
void expect_the_tables_of(const SparseGrid<Dim>& grid, const device::TileTables<Dim>& tables,
                          const Particles<Dim>& particles) {
  ASSERT_EQ(tables.particles, particles.size());
  ASSERT_EQ(tables.tiles, grid.tiles().size());
  ASSERT_EQ(tables.blocks, grid.blocks().size());
  expect_the_same(tables.order, grid.order(), "order");
  expect_the_same(tables.block_keys, grid.blocks(), "blocks");
  TableMemory memory;
  static_cast<void>(grid.tables(memory));
  expect_the_same(tables.tile_keys, memory.tile_keys, "tiles");
  expect_the_same(tables.first_of_cell, memory.first_of_cell, "cells");
  constexpr auto stencil = static_cast<std::size_t>(Tile<Dim>::stencil),
                 nodes = static_cast<std::size_t>(Tile<Dim>::nodes);
  for (std::size_t t = 0; t < tables.tiles; ++t) {
    for (std::size_t d = 0; d < stencil; ++d) {
      EXPECT_EQ(tables.blocks_about_tile[t * stencil + d], grid.blocks_about_tile(t)[d]);
    }
    for (std::size_t cell = 0; cell < nodes; ++cell) {
      for (std::size_t k = tables.first_of_cell[t * nodes + cell]; k < tables.first_of_cell[t * nodes + cell + 1];
           ++k) {
        EXPECT_EQ(tables.keys[k] & (nodes - 1), cell);
      }
    }
  }
  for (std::size_t b = 0; b < tables.blocks; ++b) {
    for (std::size_t d = 0; d < stencil; ++d) {
      EXPECT_EQ(tables.tiles_about_block[b * stencil + d], grid.tiles_about_block(b)[d]);
      EXPECT_EQ(tables.blocks_about_block[b * stencil + d], grid.blocks_about_block(b)[d]);
    }
  }
}

// The grid sorts particles in memory only at the beginning, the device never: the order in memory is then the same.
// layers: the second body has separate tiles until it moves to those of the first one.
template <int Dim>
void expect_the_tables_of_the_grid(std::size_t count, const Host& with, bool layers) {
  Particles<Dim> particles;
  scatter(count, particles);
  SparseGrid<Dim> grid(0.7);
  if (layers) {
    grid.set_layers({0, 1});
  }
  grid.update(particles, 0);
  Host host = with;
  device::Particles<Host, Dim> on_device(host, view_of(particles), count);
  device::Cells<Host, Dim> cells(host, 0.7, {});
  if (layers) {
    cells.set_layers({0, 1});
  }
  cells.update(on_device.view(), on_device.by_id(), count);
  host.wait();
  EXPECT_TRUE(cells.blocks_changed());
  expect_the_tables_of(grid, cells.tables(), particles);
  std::mt19937 random(4);
  bool any_kept = false;
  for (int step = 0; step < 6; ++step) {
    for (std::size_t p = 0; p < count; ++p) {
      // In the last steps too little to leave a cell, except for one particle that moves far.
      const double distance = step < 3 ? 0.1 : 1e-9;
      for (int a = 0; a < Dim; ++a) {
        particles.position(p, a) += std::uniform_real_distribution<double>(-distance, distance)(random);
      }
    }
    particles.position(count / 2, 0) += step == 4 ? 40.0 : 0.0;
    if (layers && step == 2) {
      grid.set_layers({0, 0});
      cells.set_layers({0, 0});
    }
    for (std::size_t p = 0; p < count; ++p) {
      for (int a = 0; a < Dim; ++a) {
        on_device.view().position(p, a) = particles.position(p, a);
      }
    }
    grid.update(particles, 0);
    cells.update(on_device.view(), on_device.by_id(), count);
    host.wait();
    EXPECT_EQ(cells.blocks_changed(), grid.blocks_changed()) << step;
    any_kept = any_kept || !cells.blocks_changed();
    expect_the_tables_of(grid, cells.tables(), particles);
  }
  EXPECT_TRUE(any_kept);
  on_device.reorder(cells.tables().order);
  cells.store_memory_order();
  host.wait();
  for (std::size_t k = 0; k < count; ++k) {
    EXPECT_EQ(cells.tables().order[k], k);
    EXPECT_EQ(on_device.view().id(k), particles.id(grid.order()[k]));
    EXPECT_EQ(on_device.view().id(on_device.by_id()[k]), static_cast<std::int64_t>(k) + 5);
  }
}

TEST(DeviceCells, HaveTheOrderAndTablesOfTheGrid) {
  for (const ThreadOrder order : {ThreadOrder::forward, ThreadOrder::backward, ThreadOrder::shuffled}) {
    for (const bool layers : {false, true}) {
      expect_the_tables_of_the_grid<2>(500, Host(order), layers);
      expect_the_tables_of_the_grid<3>(300, Host(order), layers);
    }
  }
}

}  // namespace
}  // namespace thawslide::mpm
