// Records of nodes. Rows without nodes of particles contribute to no node, and every number of the other rows is
// included. Records of selected blocks store their values and read zeros elsewhere.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "base/error.hpp"
#include "mpm/node_pass.hpp"
#include "mpm/transfer.hpp"

namespace thawslide::mpm {
namespace {

constexpr double cell = 5.0;
constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();

// Few particles: most rows of most tiles contain no nodes of particles.
template <int Dim>
struct Sprinkled {
  Particles<Dim> particles;
  SparseGrid<Dim> grid{cell};

  Sprinkled() {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> place(10.0, 90.0);
    particles.resize(40);
    for (std::size_t p = 0; p < particles.size(); ++p) {
      particles.id(p) = static_cast<std::int64_t>(p);
      for (int a = 0; a < Dim; ++a) {
        particles.position(p, a) = place(random);
      }
    }
    grid.update(particles, 0);
  }

  // Returns whether the node at a place of tile t's patch belongs to a particle of the tile.
  [[nodiscard]] bool sees(std::size_t t, int place) const {
    for (const auto& batch : grid.batches(t)) {
      for (const std::int32_t lowest : batch.nodes.first) {
        for (std::size_t k = 0; k < static_cast<std::size_t>(Tile<Dim>::stencil); ++k) {
          if (lowest + static_cast<int>(place_of(k)) == place) {
            return true;
          }
        }
      }
    }
    return false;
  }
  static std::size_t place_of(std::size_t k) {
    constexpr auto edge = static_cast<std::size_t>(Tile<Dim>::patch_edge);
    return (k / 9 * edge + k / 3 % 3) * edge + k % 3;
  }
};

template <int Dim>
void expect_seen_rows_to_hold_all_nodes_that_are_seen() {
  const Sprinkled<Dim> scene;
  std::size_t unseen = 0;
  for (std::size_t t = 0; t < scene.grid.tiles().size(); ++t) {
    for (int row = 0; row < Tile<Dim>::patch_rows; ++row) {
      bool any = false;
      for (int i = 0; i < Tile<Dim>::patch_edge; ++i) {
        any = any || scene.sees(t, row * Tile<Dim>::patch_edge + i);
      }
      EXPECT_EQ((scene.grid.rows_seen(t) >> row & 1) != 0, any) << "tile " << t << ", row " << row;
      unseen += any ? 0 : 1;
    }
  }
  EXPECT_GT(unseen, 0u);  // otherwise the test has no effect
}

// Every node of every patch has a number; outside the seen rows it is NaN.
template <int Dim>
void expect_sums_of_seen_rows(bool of_all_tiles) {
  Sprinkled<Dim> scene;
  const auto& grid = scene.grid;
  const auto accepts = [&](std::size_t t) { return of_all_tiles || t % 2 == 0; };
  Nodes<Dim> nodes;
  nodes.averages.resize(grid.blocks().size());
  auto patches = nodes.averages.patches(grid.tiles().size());
  for (std::size_t t = 0; t < patches.size(); ++t) {
    for (std::size_t place = 0; place < patches[t].records.size(); ++place) {
      const bool seen = (grid.rows_seen(t) >> place / static_cast<std::size_t>(Tile<Dim>::patch_edge) & 1) != 0;
      const double number = seen ? std::ldexp(1.0, static_cast<int>(place % 7)) + static_cast<double>(t) : nowhere;
      patches[t].records[place] = {number, -number, 2.0 * number, 0.0};
    }
  }
  std::size_t left_out = 0;
  for (std::size_t b = 0; b < grid.blocks().size(); ++b) {
    std::fill_n(nodes.averages.of_block(b), nodes.averages.nodes, typename decltype(nodes.averages)::Record{99.0});
    const std::uint32_t rows = sum_block<Averages>(grid, b, nodes, accepts);
    EXPECT_EQ(rows, rows_seen_in_block(grid, b));
    std::array<double, static_cast<std::size_t>(Tile<Dim>::nodes)> sums{};
    std::uint32_t seen_by_some = 0;
    for_each_direction<Dim>([&](auto d) {
      const std::int32_t tile = grid.tiles_about_block(b)[d];
      if (tile == KeyIndex::absent) {
        return;
      }
      const auto t = static_cast<std::size_t>(tile);
      for_shared_nodes<Dim, opposite<Dim>(d)>([&](std::size_t in_block, std::size_t in_patch) {
        if ((grid.rows_seen(t) >> in_patch / static_cast<std::size_t>(Tile<Dim>::patch_edge) & 1) != 0) {
          seen_by_some |= std::uint32_t{1} << in_block / static_cast<std::size_t>(Tile<Dim>::edge);
          sums[in_block] += accepts(t) ? patches[t].records[in_patch][0] : 0.0;
        }
      });
    });
    EXPECT_EQ(rows, seen_by_some);
    for (std::size_t k = 0; k < sums.size(); ++k) {
      if ((rows >> k / static_cast<std::size_t>(Tile<Dim>::edge) & 1) != 0) {
        EXPECT_EQ(nodes.averages(b, k)[0], sums[k]) << "block " << b << ", node " << k;
        EXPECT_EQ(nodes.averages(b, k)[2], 2.0 * sums[k]);
      } else {
        ++left_out;
      }
    }
  }
  EXPECT_GT(left_out, 0u);
}

// Patches contain all numbers that particles read, although other rows are left out; sum_patches sets every node.
template <int Dim>
void expect_patches_of_seen_rows() {
  Sprinkled<Dim> scene;
  const auto& grid = scene.grid;
  NodeRecords<Dim, 3> records(std::make_shared<PatchPool>());
  auto patches = records.patches(grid.tiles().size());
  for (std::size_t t = 0; t < patches.size(); ++t) {
    std::fill(patches[t].records.begin(), patches[t].records.end(), std::array<double, 4>{nowhere});
    patches[t].clear(grid.rows_seen(t));
    patches[t].for_rows(grid.rows_seen(t), [](auto* row) { row[1][0] = 1.0; });
    EXPECT_EQ(patches[t].rows_with(grid.rows_seen(t), [](const auto& record) { return record[0] == 1.0; }),
              grid.rows_seen(t));
    EXPECT_EQ(patches[t].rows_with(grid.rows_seen(t), [](const auto& record) { return std::isnan(record[0]); }), 0u);
  }
  sum_patches(grid, records);
  for (std::size_t b = 0; b < grid.blocks().size(); ++b) {
    for (std::size_t k = 0; k < records.nodes; ++k) {
      EXPECT_FALSE(std::isnan(records(b, k)[0])) << "block " << b << ", node " << k;
    }
  }
  for (std::size_t t = 0; t < grid.tiles().size(); ++t) {
    Patch<Dim, 3> seen;
    std::fill(seen.records.begin(), seen.records.end(), std::array<double, 4>{nowhere});
    load_patch(grid, t, records, seen);
    for (std::size_t place = 0; place < seen.records.size(); ++place) {
      EXPECT_EQ(std::isnan(seen.records[place][0]),
                (grid.rows_seen(t) >> place / static_cast<std::size_t>(Tile<Dim>::patch_edge) & 1) == 0);
    }
  }
}

TEST(SeenRows, ContainAllNodesOfParticles) {
  expect_seen_rows_to_hold_all_nodes_that_are_seen<2>();
  expect_seen_rows_to_hold_all_nodes_that_are_seen<3>();
}

TEST(SeenRows, AreSummedExclusivelyAndCompletely) {
  for (const bool of_all_tiles : {true, false}) {
    expect_sums_of_seen_rows<2>(of_all_tiles);
    expect_sums_of_seen_rows<3>(of_all_tiles);
  }
}

TEST(SeenRows, AreClearedAndReadExclusively) {
  expect_patches_of_seen_rows<2>();
  expect_patches_of_seen_rows<3>();
}

using Records = SparseRecords<2, 3>;

TEST(SparseRecords, StoreRequestedBlocksAndReadZerosElsewhere) {
  Records records;
  records.allocate(5, [](std::size_t /*block*/) { return true; });
  for (std::size_t block = 0; block < 5; ++block) {
    std::fill_n(records.of_block(block), Records::nodes, Records::Record{7.0, 7.0, 7.0, 7.0});
  }
  const auto is_kept = [](std::size_t block) { return block == 1 || block == 4; };
  records.allocate(5, is_kept);  // releases the others
  for (const std::size_t block : {1u, 4u}) {
    for (std::size_t k = 0; k < Records::nodes; ++k) {
      records.of_block(block)[k] = {static_cast<double>(100 * block + k), 1.0, 2.0, 0.0};
    }
  }
  for (std::size_t block = 0; block < 5; ++block) {
    ASSERT_EQ(records.contains(block), is_kept(block));
    for (std::size_t k = 0; k < Records::nodes; ++k) {
      const auto stored = Records::Record{static_cast<double>(100 * block + k), 1.0, 2.0, 0.0};
      EXPECT_EQ(records(block, k), is_kept(block) ? stored : Records::Record{}) << block << ", " << k;
      EXPECT_EQ(records(NodeAt{block, k})[1], is_kept(block) ? 1.0 : 0.0);
    }
    if (!is_kept(block)) {
      EXPECT_THROW(static_cast<void>(records.of_block(block)), InternalError);
    }
  }
}

}  // namespace
}  // namespace thawslide::mpm
