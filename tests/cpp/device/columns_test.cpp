// The columns of the slide as summed by a device (device/columns.hpp) are bitwise identical to those of
// band::FlowDepth, for any order of threads.
#include "device/columns.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "../support/two_bodies.hpp"
#include "device/cells.hpp"
#include "device/host_backend.hpp"
#include "device/particles.hpp"
#include "scene.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;
using device::Host, device::ThreadOrder;

// A different value for every column.
template <int Dim>
double cosine_at(const Vector<double, Dim - 1>& place) {
  return 1.0 / (1.0 + 1e-3 * place.squaredNorm());
}
template <int Dim>
double gravity_at(const Vector<double, Dim - 1>& place) {
  return 9.81 - 1e-3 * place.sum();
}

// Thickness, top and cosine for each tile, and the loads of particles, in canonical order.
template <int Dim>
std::vector<double> by_flow_depth(Scene<Dim>& scene) {
  band::FlowDepth<Dim> depth;
  depth.update(scene.grid, scene.model.band, cosine_at<Dim>, scene.particles);
  std::vector<double> numbers;
  for (std::size_t t = 0; t < scene.grid.tiles().size(); ++t) {
    const auto columns = depth.of_tile(scene.grid, t);
    for (const auto& of_tile : {columns.thickness, columns.top, columns.cosine}) {
      numbers.insert(numbers.end(), of_tile.numbers.begin(), of_tile.numbers.end());
    }
  }
  depth.load_to_particles(scene.grid, gravity_at<Dim>, scene.particles);
  for (const std::uint32_t p : scene.grid.order()) {
    numbers.push_back(scene.particles.normal_load(p));
  }
  return numbers;
}

template <int Dim>
std::vector<double> on_device(Scene<Dim>& scene, Host host) {
  const double cell = scene.grid.cell();
  std::vector<double> half_sizes;
  for (std::size_t body = 0; body < scene.model.body_names.size(); ++body) {
    half_sizes.push_back(scene.model.motion.sizes.half(body));
  }
  device::Particles<Host, Dim> on_host(host, mpm::view_of(scene.particles), scene.particles.size());
  device::Cells<Host, Dim> cells(host, cell);
  cells.update(on_host.view(), on_host.by_id(), scene.particles.size());
  const device::TileTables<Dim> tables = cells.tables();
  device::Columns<Host, Dim> columns(host, cell, half_sizes, cosine_at<Dim>, gravity_at<Dim>);
  columns.update(tables);
  columns.sum(tables, on_host.view());
  host.wait();
  std::vector<double> numbers;
  for (std::size_t t = 0; t < tables.tiles; ++t) {
    const auto seen = columns.seen(tables).of_tile(t);
    for (const auto& of_tile : {seen.thickness, seen.top, seen.cosine}) {
      for (std::size_t place = 0; place < band::columns_per_tile<Dim>; ++place) {
        numbers.push_back(of_tile.at(static_cast<double>(place)));
      }
    }
  }
  constexpr auto nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);
  for (std::size_t t = 0, k = 0; t < tables.tiles; ++t) {
    const auto loading = columns.loading(tables).of_tile(t);
    for (; k < tables.first_of_cell[(t + 1) * nodes]; ++k) {
      numbers.push_back(loading.flow_depth(on_host.view(), mpm::ScalarIndex{{tables.order[k]}}));
    }
  }
  return numbers;
}

bool are_same(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

template <int Dim>
void expect_the_columns_of_the_cpu(int barriers) {
  Simulation<Dim> simulation(two_bodies<Dim>(2e4, 3.0, 3.0, 12.0));
  for (int k = 0; k < 60; ++k) {
    simulation.step(0.002);
  }
  Scene<Dim> scene(simulation);
  const std::vector<double> expected = by_flow_depth(scene);
  EXPECT_TRUE(std::all_of(expected.begin(), expected.end(), [](double number) { return std::isfinite(number); }));
  for (const ThreadOrder order : {ThreadOrder::forward, ThreadOrder::backward, ThreadOrder::shuffled}) {
    for (const std::size_t threads : {std::size_t{32}, std::size_t{7}}) {
      EXPECT_TRUE(are_same(expected, on_device(scene, Host(order, threads))))
          << threads << " threads, order " << static_cast<int>(order);
    }
  }
  for (int barrier = 0; barrier < barriers; ++barrier) {
    EXPECT_FALSE(are_same(expected, on_device(scene, Host(ThreadOrder::shuffled, 7, barrier))))
        << "barrier " << barrier;
  }
}

TEST(DeviceColumns, AgreeWithTheFlowDepthInThePlane) { expect_the_columns_of_the_cpu<2>(1); }

// Tiles with more particles than a group processes at a time.
TEST(DeviceColumns, AgreeWithTheFlowDepthInSpace) { expect_the_columns_of_the_cpu<3>(2); }

}  // namespace
}  // namespace thawslide::sim
