// The sparse grid while particles move, compared with results from their positions alone; adjacent nodes and
// constraints of blocks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <tuple>

#include "mpm/constraints.hpp"

namespace thawslide::mpm {
namespace {

constexpr double cell = 5.0;

// Particles of two materials in a box; those on one side move far, the others little.
template <int Dim>
class Crowd {
 public:
  explicit Crowd(std::size_t count) {
    particles.resize(count);
    place_from(0, 0);
  }

  void move(double most) {
    std::uniform_real_distribution<double> step(-most, most);
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const double pace = particles.position(p, 0) < 30.0 ? 1.0 : 1e-3;
      for (int a = 0; a < Dim; ++a) {
        particles.position(p, a) = std::clamp(particles.position(p, a) + pace * step(random_), 1.0, 69.0);
      }
    }
  }

  // Removes particles at random, or those beyond x = `from`; returns the new indices of the others.
  std::vector<std::uint32_t> remove(double fraction, double from) {
    std::bernoulli_distribution is_removed(fraction);
    std::vector<std::uint8_t> marked(particles.size());
    for (std::size_t p = 0; p < marked.size(); ++p) {
      marked[p] = is_removed(random_) || particles.position(p, 0) > from ? 1 : 0;
    }
    return particles.remove(marked);
  }

  void append(std::size_t count) {
    place_from(particles.append(count), next_id_);
    next_id_ += static_cast<std::int64_t>(count);
  }

  Particles<Dim> particles;

 private:
  // Places particles from an index on at random, with consecutive ids.
  void place_from(std::size_t first, std::int64_t id) {
    std::uniform_real_distribution<double> place(10.0, 60.0);
    for (std::size_t p = first; p < particles.size(); ++p) {
      particles.id(p) = id++;
      particles.material(p) = p % 5 == 0 ? 1 : 0;
      for (int a = 0; a < Dim; ++a) {
        particles.position(p, a) = place(random_);
      }
    }
  }

  std::int64_t next_id_ = 1'000'000;
  std::mt19937 random_{7};
};

// Tile of a particle's nearest node, the node's index in it, and the particle's id: the key of the canonical order.
template <int Dim>
std::tuple<std::uint64_t, int, std::int64_t> canonical(const Particles<Dim>& particles, std::size_t p) {
  typename Tile<Dim>::Index node{}, tile{};
  int local = 0;
  for (int a = 0; a < Dim; ++a) {
    node[static_cast<std::size_t>(a)] = static_cast<int>(std::lround(particles.position(p, a) / cell));
  }
  Tile<Dim>::split(node, tile, local);
  return {Tile<Dim>::key(tile), local, particles.id(p)};
}

// Index in the patch of a tile of the node number(axis).
template <int Dim, class Number>
int index_in_patch(std::uint64_t tile_key, const Number& number) {
  typename Tile<Dim>::Index relative = Tile<Dim>::index(tile_key);
  for (int a = 0; a < Dim; ++a) {
    auto& along = relative[static_cast<std::size_t>(a)];
    along = number(a) - along * Tile<Dim>::edge;
  }
  return Tile<Dim>::in_patch(relative);
}

template <int Dim>
void expect_tiles_and_blocks(const Particles<Dim>& particles, const SparseGrid<Dim>& grid) {
  using T = Tile<Dim>;
  const auto key_of = [&](std::uint32_t p) { return std::get<0>(canonical(particles, p)); };
  const auto& order = grid.order();
  ASSERT_EQ(order.size(), particles.size());
  std::set<std::uint64_t> blocks;
  std::uint32_t placed = 0;
  for (const auto& tile : grid.tiles()) {
    EXPECT_EQ(tile.first, placed);
    placed = tile.last;
    EXPECT_TRUE(std::all_of(order.begin() + tile.first, order.begin() + tile.last,
                            [&](std::uint32_t p) { return key_of(p) == tile.key; }));
    for (int d = 0; d < T::stencil; ++d) {
      auto index = T::index(tile.key);
      for (int a = 0, rest = d; a < Dim; ++a, rest /= 3) {
        index[static_cast<std::size_t>(a)] += rest % 3 - 1;
      }
      blocks.insert(T::key(index));
    }
  }
  EXPECT_EQ(placed, order.size());
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return canonical(particles, a) < canonical(particles, b);
  }));
  EXPECT_TRUE(std::equal(blocks.begin(), blocks.end(), grid.blocks().begin(), grid.blocks().end()));
}

// Runs of lanes with the same nodes, in a batch whose lanes are in canonical order.
void expect_runs(const BatchNodes& nodes) {
  std::vector<std::size_t> begins{0};
  for (std::size_t lane = 1; lane < nodes.first.size(); ++lane) {
    if (nodes.first[lane] != nodes.first[lane - 1]) {
      begins.push_back(lane);
    }
  }
  EXPECT_EQ(nodes.runs, std::min<std::size_t>(begins.size(), BatchNodes::irregular));
  EXPECT_TRUE(begins.size() != 2 || nodes.second_run_begin == begins[1]);
}

template <int Dim>
void expect_batches(const Particles<Dim>& particles, const SparseGrid<Dim>& grid) {
  for (std::size_t t = 0; t < grid.tiles().size(); ++t) {
    const auto& tile = grid.tiles()[t];
    std::uint32_t place = tile.first;
    for (const TileBatch<Dim>& batch : grid.batches(t)) {
      for (std::size_t lane = 0; lane < batch.count; ++lane, ++place) {
        const std::uint32_t p = batch.particle[lane];
        EXPECT_EQ(p, grid.order()[place]);
        EXPECT_EQ(particles.material(p), particles.material(batch.particle[0]));
        const auto nearest = [&](int a) { return static_cast<int>(std::lround(particles.position(p, a) / cell)); };
        for (int a = 0; a < Dim; ++a) {
          EXPECT_EQ(batch.nearest[static_cast<std::size_t>(a)][lane], nearest(a));
        }
        EXPECT_EQ(batch.nodes.first[lane], index_in_patch<Dim>(tile.key, [&](int a) { return nearest(a) - 1; }));
        EXPECT_TRUE(!batch.contiguous || p == batch.particle[0] + lane);
      }
      expect_runs(batch.nodes);
      const auto same_node = [&](std::uint32_t k) {
        const auto [key, local, id] = canonical(particles, grid.order()[k]);
        const auto [last_key, last_local, last_id] = canonical(particles, batch.particle[batch.count - 1]);
        return key == last_key && local == last_local;
      };
      EXPECT_EQ(batch.nodes.continues, place < tile.last && same_node(place));
    }
    EXPECT_EQ(place, tile.last);
  }
}

// is_fixed: no particles are added or removed. Otherwise, also immediately after a removal.
template <int Dim>
void expect_the_grid_to_follow(bool is_fixed) {
  Crowd<Dim> crowd(Dim == 3 ? 900 : is_fixed ? 60 : 200);
  SparseGrid<Dim> grid(cell);
  int changes_of_blocks = 0;
  for (int step = 0; step < 60 && !testing::Test::HasFailure(); ++step) {
    SCOPED_TRACE(step);
    grid.update(crowd.particles, 17);
    changes_of_blocks += grid.blocks_changed() ? 1 : 0;
    expect_tiles_and_blocks(crowd.particles, grid);
    expect_batches(crowd.particles, grid);
    if (!is_fixed && step % 2 == 0) {
      grid.remove(crowd.particles, crowd.remove(step % 4 == 0 ? 0.05 : 0.0, step % 10 == 0 ? 45.0 : 68.0));
      expect_tiles_and_blocks(crowd.particles, grid);
      expect_batches(crowd.particles, grid);
    }
    if (!is_fixed && step % 3 == 0) {
      crowd.append(Dim == 2 ? 15 : 60);
    }
    crowd.move(step % 3 == 0 ? 3.0 : step % 3 == 1 ? 0.1 : 0.0);
  }
  EXPECT_GT(changes_of_blocks, 3);
  EXPECT_TRUE(!is_fixed || changes_of_blocks < 40);
}

TEST(SparseGrid, FollowsParticlesInThePlane) { expect_the_grid_to_follow<2>(true); }
TEST(SparseGrid, FollowsParticlesInSpace) { expect_the_grid_to_follow<3>(true); }
TEST(SparseGrid, FollowsAddedAndRemovedParticlesInThePlane) { expect_the_grid_to_follow<2>(false); }
TEST(SparseGrid, FollowsAddedAndRemovedParticlesInSpace) { expect_the_grid_to_follow<3>(false); }

TEST(Particles, KeepTheirValuesWhenOthersAreRemovedAndNewOnesAreZero) {
  Particles<2> particles;
  particles.resize(21);
  for (std::size_t p = 0; p < 21; ++p) {
    particles.id(p) = static_cast<std::int64_t>(p);
    particles.velocity(p, 1) = 10.0 * static_cast<double>(p);
  }
  std::vector<std::uint8_t> marked(21, 0);
  for (const std::size_t p : {0U, 3U, 4U, 19U, 20U}) {
    marked[p] = 1;
  }
  const auto now_at = particles.remove(marked);
  ASSERT_EQ(particles.size(), 16U);
  for (std::size_t p = 0; p < 21; ++p) {
    EXPECT_EQ((now_at[p] == Particles<2>::nowhere), marked[p] == 1) << p;
    if (marked[p] == 0) {
      EXPECT_EQ(particles.id(now_at[p]), static_cast<std::int64_t>(p));
      EXPECT_EQ(particles.velocity(now_at[p], 1), 10.0 * static_cast<double>(p));
    }
  }
  for (int c = 0; c < 2; ++c) {  // as a device leaves it in the rest of a block
    particles.velocity(16, c) = 7.0;
  }
  EXPECT_EQ(particles.append(5), 16U);
  for (std::size_t p = 16; p < 21; ++p) {
    EXPECT_EQ(particles.velocity(p, 0), 0.0);
    EXPECT_EQ(particles.velocity(p, 1), 0.0);
    EXPECT_EQ(particles.id(p), 0);
  }
}

// Calls of update after a large move until particles are in canonical order in memory, or `most` if they never are.
int calls_until_sorted(int interval, int most) {
  Crowd<2> crowd(5000);
  for (std::size_t p = 0; p < crowd.particles.size(); ++p) {
    crowd.particles.material(p) = 0;  // particles of two materials in turn never fill a batch
  }
  SparseGrid<2> grid(cell);
  grid.update(crowd.particles, interval);
  EXPECT_TRUE(std::is_sorted(grid.order().begin(), grid.order().end()));
  crowd.move(3.0);
  for (int call = 0; call < most; ++call) {
    grid.update(crowd.particles, interval);
    if (std::is_sorted(grid.order().begin(), grid.order().end())) {
      return call;
    }
  }
  return most;
}

TEST(SparseGrid, SortsParticlesWhenScatteredOrAfterTheInterval) {
  EXPECT_EQ(calls_until_sorted(3, 100), 2);
  const int when_scattered = calls_until_sorted(1'000'000, 100);
  EXPECT_GT(when_scattered, 2);
  EXPECT_LT(when_scattered, 20);
  EXPECT_EQ(calls_until_sorted(0, 100), 100);
}

TEST(Tile, FindsAdjacentNodes) {
  using T = Tile<3>;
  for (int local = 0; local < T::nodes; ++local) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int shift = -3; shift <= 3; ++shift) {
        T::Index node = T::node({}, local), tile{};
        node[static_cast<std::size_t>(axis)] += shift;
        int place = 0;
        T::split(node, tile, place);
        const auto adjacent = T::adjacent(local, axis, shift);
        EXPECT_EQ(adjacent.local, place);
        EXPECT_EQ(adjacent.direction, ((tile[2] + 1) * 3 + tile[1] + 1) * 3 + tile[0] + 1);
      }
    }
  }
}

// The layer of a tile does not change its position, and no particle's key has all bits set.
template <int Dim>
void expect_layers_above_places() {
  using T = Tile<Dim>;
  typename T::Index lowest, highest, middle;
  lowest.fill(-T::axis_offset);
  highest.fill(T::axis_offset - 1);
  middle.fill(-3);
  for (const typename T::Index& index : {lowest, middle, highest}) {
    for (std::uint64_t layer = 0; layer < T::most_layers; ++layer) {
      const std::uint64_t key = T::in_layer(T::key(index), layer);
      EXPECT_EQ(T::index(key), index);
      EXPECT_EQ(T::layer(key), layer);
      EXPECT_EQ(T::without_layer(key), T::key(index));
      EXPECT_EQ(key << T::node_bits >> T::node_bits, key) << "the bits of the node are free";
      EXPECT_NE((key << T::node_bits | (T::nodes - 1)), ~std::uint64_t{0});
    }
  }
}

TEST(Tile, StoresItsLayerAboveItsPosition) {
  expect_layers_above_places<2>();
  expect_layers_above_places<3>();
}

// A block that reports no constraints has none, and many blocks report so.
TEST(BlockConstraints, AgreeWithThoseOfTheirNodes) {
  Constraints<2> constraints;
  constraints.conditions = {
      DomainFaces<2>{{70.0, 70.0}, {BoundaryKind::fixed, BoundaryKind::open, BoundaryKind::open, BoundaryKind::roller}},
      RigidFrame<2>{{30.0, 22.0}, {33.0, 38.0}, 0, 4.0}};
  Crowd<2> crowd(3000);
  SparseGrid<2> grid(cell);
  grid.update(crowd.particles, 64);
  for (const double time : {0.0, 1.0, 2.75}) {
    std::size_t blocks_without = 0, nodes_with = 0;
    for (std::size_t b = 0; b < grid.blocks().size(); ++b) {
      const BlockConstraints<2> on_block(grid, constraints, b, time);
      blocks_without += on_block(NodeAt{b, 0}).any() ? 0 : 1;
      for (std::size_t k = 0; k < static_cast<std::size_t>(Tile<2>::nodes); ++k) {
        Vector<double, 2> free(3.0, 5.0), held = free;
        const bool in_frame = constraints.motion().apply(node_position(grid, b, k), 2.0, time, free);
        EXPECT_EQ(on_block(NodeAt{b, k}).apply(2.0, held), in_frame);
        EXPECT_EQ(held, free);
        nodes_with += held != Vector<double, 2>(3.0, 5.0) ? 1 : 0;
      }
    }
    EXPECT_GT(nodes_with, 20u);
    EXPECT_GT(blocks_without, grid.blocks().size() / 4);
  }
}

}  // namespace
}  // namespace thawslide::mpm
