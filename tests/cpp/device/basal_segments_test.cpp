// Basal segments on an emulated device: bitwise those of the CPU while they stretch, split, merge, and are created and
// removed.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "../physics/band_column_model.hpp"
#include "band/base_state.hpp"
#include "device/host_backend.hpp"
#include "mpm/nodes.hpp"

namespace thawslide::device {
namespace {

constexpr double cell = 4.0;
constexpr int blocks_along = 6;

// Level ground at the nodes of layer 0.
template <int Dim>
struct LevelGround {
  struct Below {
    double height;
    Vector<double, Dim> normal;
  };
  [[nodiscard]] static Below below(const Vector<double, Dim - 1>& /*point*/) { return {0.0, down()}; }
  [[nodiscard]] static double width(const Vector<double, Dim - 1>& /*point*/) { return 1.0; }
  [[nodiscard]] static Vector<double, Dim> down() { return -Vector<double, Dim>::Unit(Dim - 1); }
};
template <int Dim>
struct Down {
  Vector<double, Dim> operator()(std::size_t /*block*/, std::size_t /*node*/) const { return LevelGround<Dim>::down(); }
};

template <int Dim>
mpm::SparseGrid<Dim> grid_of_blocks() {
  using T = mpm::Tile<Dim>;
  std::vector<std::uint64_t> keys;
  for (int n = 0; n < 3 * mpm::power(blocks_along, Dim - 1); ++n) {
    typename T::Index tile{};
    tile[Dim - 1] = n % 3 - 1;
    for (int a = 0, rest = n / 3; a + 1 < Dim; ++a, rest /= blocks_along) {
      tile[static_cast<std::size_t>(a)] = rest % blocks_along;
    }
    keys.push_back(T::key(tile));
  }
  std::sort(keys.begin(), keys.end());
  mpm::SparseGrid<Dim> grid(cell);
  grid.set_blocks(std::move(keys));
  return grid;
}

// A sliding mass that covers a square, which moves along x. It stretches along x, and contracts along y.
template <int Dim>
void place_slide(const mpm::SparseGrid<Dim>& grid, double time, mpm::Nodes<Dim>& nodes) {
  constexpr double rate = 0.8;  // [1/s]
  Vector<double, Dim> middle = Vector<double, Dim>::Constant(2.0 * blocks_along * cell);
  middle[0] += 4.0 * time;
  const std::size_t blocks = grid.blocks().size();
  const auto is_near = [&](std::size_t b) { return mpm::Tile<Dim>::index(grid.blocks()[b])[Dim - 1] <= 0; };
  nodes.contact.allocate(blocks, is_near);
  nodes.momentum.resize(blocks);
  nodes.motion.resize(blocks);
  for (std::size_t b = 0; b < blocks; ++b) {
    for (std::size_t k = 0; k < nodes.contact.nodes; ++k) {
      nodes.momentum.of_block(b)[k] = {};
      nodes.motion.of_block(b)[k] = {};
      const Vector<double, Dim> from_middle = mpm::node_position(grid, b, k) - middle;
      const double height = mpm::node_position(grid, b, k)[Dim - 1];
      const bool is_covered = from_middle.template head<Dim - 1>().cwiseAbs().maxCoeff() < 5.5 * cell;
      if (is_covered && height >= 0.0 && height < 2.5 * cell) {
        nodes.momentum.of_block(b)[k][mpm::MomentumLayout<Dim>::mass] = 1e5;
        auto& motion = nodes.motion.of_block(b)[k];
        motion[mpm::MotionLayout<Dim>::middle_velocity] = 4.0 + rate * from_middle[0];
        if constexpr (Dim == 3) {
          motion[mpm::MotionLayout<Dim>::middle_velocity + 1] = -rate * from_middle[1];
        }
      }
      if (is_near(b)) {
        auto& contact = nodes.contact.of_block(b)[k];
        contact = {};
        if (is_covered && height == 0.0) {
          contact[mpm::Contact::touching] = 1.0;
          contact[mpm::Contact::area] = Dim == 2 ? cell : cell * cell;
          contact[mpm::Contact::normal_force] = 2e5 * contact[mpm::Contact::area];
          contact[mpm::Contact::slip_speed] = 10.0;
          contact[mpm::Contact::friction_heat] = 1e5 * contact[mpm::Contact::area];
        }
      }
    }
  }
}

template <int Dim>
band::ColumnsModel columns_model() {
  band::ColumnsModel model;
  model.column = physics::make_model();
  model.body_temperature = model.ground_temperature = -10.0;
  model.load_time = 0.5;
  model.step = 0.1;
  model.mixing_slip = 50.0;
  model.density = 2000.0;
  model.rock_density = 2750.0;
  model.largest_thickness = 40.0;
  return model;
}

template <int Dim>
std::vector<double> numbers_of(const band::SegmentsState<Dim>& state) {
  std::vector<double> numbers{static_cast<double>(state.next_id), state.time_since_step};
  band::ColumnLedger budget = state.budget;
  budget.for_each([&](double term) { numbers.push_back(term); });
  for (const band::BasalSegment<Dim>& segment : state.segments) {
    numbers.push_back(static_cast<double>(segment.id));
    numbers.insert(numbers.end(), segment.position.begin(), segment.position.end());
    numbers.insert(numbers.end(), segment.velocity.begin(), segment.velocity.end());
    numbers.insert(numbers.end(), segment.sides.data(), segment.sides.data() + segment.sides.size());
    numbers.insert(numbers.end(), {segment.area, segment.slip, segment.load, segment.depth, segment.heat,
                                   segment.liquid, segment.means.temperature});
    numbers.insert(numbers.end(), segment.column.heat, segment.column.heat + physics::ColumnCells::all);
  }
  return numbers;
}

template <int Dim>
void expect_the_same_segments(ThreadOrder order) {
  const auto grid = grid_of_blocks<Dim>();
  const auto tables = grid.block_tables();
  const auto model = columns_model<Dim>();
  const Vector<double, Dim> gravity = 9.81 * LevelGround<Dim>::down();
  exec::Cpu cpu;
  Host device(order);
  band::BasalSegments<exec::Cpu, Dim> on_cpu(cpu, model, cell, gravity);
  band::BasalSegments<Host, Dim> on_device(device, model, cell, gravity);
  mpm::Nodes<Dim> nodes;
  constexpr double dt = 0.04;
  std::size_t most = 0, at_end = 0, merged = 0;
  for (int k = 0; k < 40; ++k) {
    place_slide<Dim>(grid, k * dt, nodes);
    const band::BaseInStep<mpm::NodeAccess<Dim>, LevelGround<Dim>, Down<Dim>, Dim> base{tables, {grid, nodes}, {}, {}};
    on_cpu.to_nodes(tables);
    on_cpu.update(base, 0.2, dt);
    on_device.to_nodes(tables);
    on_device.update(base, 0.2, dt);
    const auto state = on_cpu.state();
    ASSERT_EQ(numbers_of<Dim>(on_device.state()), numbers_of<Dim>(state)) << "after step " << k;
    merged += state.segments.size() < at_end ? 1 : 0;
    at_end = state.segments.size();
    most = std::max(most, at_end);
  }
  const auto state = on_cpu.state();
  EXPECT_GT(most, 8u);
  EXPECT_GT(static_cast<std::size_t>(state.next_id), most) << "segments are split, or created later";
  EXPECT_GT(merged, 0u);
  EXPECT_GT(state.budget.left_water, 0.0) << "segments that the slide has left are removed";
}
TEST(DeviceBasalSegments, AreThoseOfTheCpuInAnyOrderOfThreads) {
  for (const ThreadOrder order : {ThreadOrder::forward, ThreadOrder::backward, ThreadOrder::shuffled}) {
    expect_the_same_segments<2>(order);
    expect_the_same_segments<3>(order);
  }
}

}  // namespace
}  // namespace thawslide::device
