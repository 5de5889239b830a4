// Exchange of basal segments with contact nodes: weights around a segment, and conservation of heat and area.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "../physics/band_column_model.hpp"
#include "band/base_state.hpp"
#include "mpm/nodes.hpp"

namespace thawslide::band {
namespace {

template <int Dim>
using Position = Vector<double, Dim>;

// Blocks on the ground and one layer of blocks below and above it, `count` along each horizontal axis.
template <int Dim>
mpm::SparseGrid<Dim> grid_of_blocks(double cell, int count) {
  using T = mpm::Tile<Dim>;
  std::vector<std::uint64_t> keys;
  for (int layer = -1; layer <= 1; ++layer) {
    for (int x = 0; x < count; ++x) {
      for (int y = 0; y < (Dim == 3 ? count : 1); ++y) {
        typename T::Index tile{};
        tile[Dim - 1] = layer;
        tile[0] = x;
        if constexpr (Dim == 3) {
          tile[1] = y;
        }
        keys.push_back(T::key(tile));
      }
    }
  }
  std::sort(keys.begin(), keys.end());
  mpm::SparseGrid<Dim> grid(cell);
  grid.set_blocks(std::move(keys));
  return grid;
}

// At random positions, weights of nodes sum to 1, their mean position is that of the segment, and each place of the
// patch is the node at the stated distance.
template <int Dim>
void expect_weights_of_nodes() {
  const double cell = 2.5;
  const auto grid = grid_of_blocks<Dim>(cell, 4);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> along(4.0 * cell, 12.0 * cell);
  for (int trial = 0; trial < 200; ++trial) {
    Position<Dim> position = Position<Dim>::Zero();
    for (int a = 0; a + 1 < Dim; ++a) {
      position[a] = along(random);
    }
    const BaseStencil<Dim> stencil(grid.block_tables(), cell, position);
    ASSERT_NE(stencil.block(), exec::absent);
    double weights = 0;
    Vector<double, Dim - 1> mean = Vector<double, Dim - 1>::Zero();
    stencil.for_each_with_offset([&](int place, double weight, const Vector<double, Dim - 1>& from_segment) {
      weights += weight;
      mean += weight * from_segment;
      const auto at = BasePatch<Dim>::node_at(grid.block_tables(), static_cast<std::size_t>(stencil.block()), place);
      ASSERT_NE(at.block, exec::absent);
      Position<Dim> node = mpm::node_position(grid, static_cast<std::size_t>(at.block), at.node);
      node.template head<Dim - 1>() -= from_segment;
      EXPECT_NEAR((position - node).norm(), 0.0, 1e-12);
    });
    EXPECT_NEAR(weights, 1.0, 1e-14);
    EXPECT_NEAR(mean.norm(), 0.0, 1e-13);
  }
}
TEST(BaseStencil, ReachesTheNodesAroundASegment2D) { expect_weights_of_nodes<2>(); }
TEST(BaseStencil, ReachesTheNodesAroundASegment3D) { expect_weights_of_nodes<3>(); }

// Node of a block in the patch of another: the same relation, seen from both.
TEST(BasePatch, IsSummedAtTheNodesThatItReads) {
  const auto grid = grid_of_blocks<3>(1.0, 3);
  const auto tables = grid.block_tables();
  int found = 0;
  for (std::size_t b = 0; b < tables.blocks; ++b) {
    for (int place = 0; place < static_cast<int>(BasePatch<3>::nodes); ++place) {
      const auto node = BasePatch<3>::node_at(tables, b, place);
      for (int direction = 0; node.block != exec::absent && direction < BasePatch<3>::directions; ++direction) {
        if (BasePatch<3>::block_about(tables, static_cast<std::size_t>(node.block), direction) ==
            static_cast<std::int32_t>(b)) {
          EXPECT_EQ(BasePatch<3>::place_in(direction, node.node), place);
          ++found;
        }
      }
    }
  }
  EXPECT_GT(found, 9 * 49 / 2);
}

// All friction heat of contact nodes, on the ground and below it, reaches the segments that contact creates.
TEST(BasalSegments, TakeTheFrictionHeatOfAllContactNodes) {
  using mpm::Contact;
  constexpr double cell = 4.0, dt = 0.02;
  const auto grid = grid_of_blocks<3>(cell, 4);
  ColumnsModel model;
  model.column = physics::make_model();
  model.body_temperature = model.ground_temperature = -10.0;
  model.load_time = model.mixing_slip = 1.0;
  model.density = 2000.0;
  model.largest_thickness = 40.0;
  model.step = 1.0;
  exec::Cpu cpu;
  BaseColumns<3> segments(cpu, model, cell, Vector<double, 3>(0.0, 0.0, -9.81));
  struct LevelGround {
    struct Below {
      double height;
      Vector<double, 3> normal;
    };
    [[nodiscard]] static Below below(const Vector<double, 2>& /*point*/) { return {0.0, {0.0, 0.0, -1.0}}; }
    [[nodiscard]] static double width(const Vector<double, 2>& /*point*/) { return 1.0; }
  };
  const auto down = [](std::size_t /*block*/, std::size_t /*node*/) { return Vector<double, 3>(0.0, 0.0, -1.0); };
  mpm::Nodes<3> nodes;
  const std::size_t blocks = grid.blocks().size();
  const auto is_near = [&](std::size_t b) { return mpm::Tile<3>::index(grid.blocks()[b])[2] <= 0; };
  nodes.near_ground.allocate(blocks, is_near);
  nodes.contact.allocate(blocks, is_near);
  nodes.momentum.resize(blocks);
  nodes.motion.resize(blocks);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(0.5, 1.5);
  double heat = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    for (std::size_t k = 0; k < nodes.contact.nodes; ++k) {
      nodes.momentum.of_block(b)[k] = {};
      nodes.motion.of_block(b)[k] = {};
      const Vector<double, 3> position = mpm::node_position(grid, b, k);
      const bool touches = position[2] <= 0.0 && position[2] >= -2.0 * cell &&
                           (position.head<2>().array() - 8.0 * cell).abs().maxCoeff() <= 3.0 * cell;
      if (!is_near(b)) {
        continue;
      }
      auto& contact = nodes.contact.of_block(b)[k];
      contact = {};
      if (touches) {
        nodes.momentum.of_block(b)[k][mpm::MomentumLayout<3>::mass] = 1e5;
        contact[Contact::touching] = 1.0;
        contact[Contact::area] = cell * cell / 3.0 * number(random);
        contact[Contact::normal_force] = 1e5 * contact[Contact::area];
        contact[Contact::slip_speed] = 10.0;
        contact[Contact::friction_heat] = 1e6 * number(random);
        heat += dt * contact[Contact::friction_heat];
      }
    }
  }
  const auto tables = grid.block_tables();
  segments.to_nodes(tables);
  segments.update(BaseInStep<mpm::NodeAccess<3>, LevelGround, decltype(down), 3>{tables, {grid, nodes}, {}, down}, 0.2,
                  dt);
  EXPECT_GT(segments.segments().size(), 30u);
  double waiting = 0;
  for (const BasalSegment<3>& segment : segments.segments()) {
    waiting += segment.heat;
  }
  EXPECT_NEAR(waiting, heat, 1e-12 * heat);
  // Nodes below the ground have the state of those on it, and areas are conserved.
  segments.to_nodes(tables);
  double area = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    const auto tile = mpm::Tile<3>::index(grid.blocks()[b]);
    for (std::size_t k = 0; tile[2] == 0 && k < BasePatch<3>::nodes_of_layer; ++k) {
      const double here = segments.states().at(b, k)[mpm::BaseState::area];
      area += here;
      auto below = tile;
      below[2] = -1;
      const auto block = static_cast<std::size_t>(grid.block_at(mpm::Tile<3>::key(below)));
      EXPECT_EQ(segments.states().at(block, k + 2 * BasePatch<3>::nodes_of_layer)[mpm::BaseState::area], here);
    }
  }
  EXPECT_NEAR(area, segments.totals().sums.area, 1e-12 * area);
}

}  // namespace
}  // namespace thawslide::band
