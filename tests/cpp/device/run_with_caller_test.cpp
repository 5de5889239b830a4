// What a caller of single steps uses: a law of its own, and nodes. Runs on the CPU emulation of the GPU backend
// compared with runs on the CPU.
#include <stdexcept>
#include <utility>
#include <vector>

#include "run_on_device.hpp"

namespace thawslide::sim {
namespace {

// Strengths of a law of the caller, which receives the loaded nodes of each step.
terrain::StrengthLaw recording(std::vector<terrain::LoadedNodes>& all) {
  return [&all](terrain::LoadedNodes& nodes) {
    all.push_back(nodes);
    for (std::size_t k = 0; k < nodes.strength.size(); ++k) {
      nodes.strength[k] = 0.2 * nodes.normal_pressure[k] + 300.0 * nodes.speed[k];
    }
  };
}
void expect_the_same_nodes(const terrain::LoadedNodes& found, const terrain::LoadedNodes& expected) {
  EXPECT_EQ(found.time, expected.time);
  EXPECT_EQ(found.dt, expected.dt);
  EXPECT_EQ(found.substrate, expected.substrate);
  using Nodes = terrain::LoadedNodes;
  for (const auto quantity : {&Nodes::position, &Nodes::area, &Nodes::normal_pressure, &Nodes::pore_pressure,
                              &Nodes::temperature, &Nodes::saturation, &Nodes::solid_fraction, &Nodes::slip,
                              &Nodes::speed, &Nodes::unit_weight, &Nodes::strength}) {
    EXPECT_EQ(found.*quantity, expected.*quantity);
  }
}
template <int Dim>
void expect_the_same_law(const Sets& more, int steps) {
  const config::Case parameters = sliding_bodies<Dim>(more);
  Simulation<Dim> on_cpu(parameters), on_device(parameters), without_law(parameters);
  on_device.use_device("a GPU", emulated_gpu<Dim>({}));
  std::vector<terrain::LoadedNodes> of_cpu, of_device;
  const terrain::StrengthLaw law_of_cpu = recording(of_cpu), law_of_device = recording(of_device);
  for (int k = 0; k < steps; ++k) {
    on_cpu.step(0.002, &law_of_cpu);
    on_device.step(0.002, &law_of_device);
    without_law.step(0.002);
    ASSERT_EQ(of_device.size(), of_cpu.size());
    expect_the_same_nodes(of_device.back(), of_cpu.back());
  }
  EXPECT_GT(of_cpu.back().strength.size(), 3);
  expect_the_same_particles(on_device, on_cpu);
  EXPECT_NE(fields_by_id(on_cpu.particles()).at("velocity"), fields_by_id(without_law.particles()).at("velocity"));
}
TEST(DeviceRunWithCaller, CallsItsLaw) {
  expect_the_same_law<2>({}, 45);
  expect_the_same_law<3>({}, 12);
  expect_the_same_law<2>(on_columns, 45);
  expect_the_same_law<2>(loose_bed() + Sets("bed.law=strength"), 60);
}
void expect_the_same_after_a_failing_law(const Sets& sets) {
  Simulation<2> on_cpu(sliding_bodies<2>(sets)), on_device(sliding_bodies<2>(sets));
  on_device.use_device("a GPU", emulated_gpu<2>({ThreadOrder::forward}));
  const terrain::StrengthLaw failing = [](terrain::LoadedNodes& nodes) {
    throw std::runtime_error(fmt::format("at {:g} s", nodes.time));
  };
  for (int k = 0; k < 40; ++k) {
    on_cpu.step(0.002);
    if (k == 20) {
      const auto& particles = std::as_const(on_device).particles();  // the device continues after the failure
      const auto before = fields_by_id(particles);
      EXPECT_THROW(on_device.step(0.002, &failing), std::runtime_error);
      EXPECT_EQ(fields_by_id(std::as_const(on_device).particles()), before);
    }
    on_device.step(0.002);
  }
  expect_the_same_particles(on_device, on_cpu);
}
TEST(DeviceRunWithCaller, KeepsTheParticlesIfItsLawFails) {
  expect_the_same_after_a_failing_law({});
  expect_the_same_after_a_failing_law(on_columns);
  expect_the_same_after_a_failing_law(loose_bed() + Sets("bed.law=strength"));
}

// Also after the caller may have changed particles, for which the device copies them back and starts again.
template <int Dim>
void expect_the_same_momentum(int steps) {
  const config::Case parameters = sliding_bodies<Dim>();
  Simulation<Dim> on_cpu(parameters), on_device(parameters);
  on_device.use_device("a GPU", emulated_gpu<Dim>({}));
  EXPECT_TRUE(on_device.momentum_of_nodes().records.empty());
  for (int k = 0; k < steps; ++k) {
    on_cpu.step(0.002);
    on_device.step(0.002);
    if (k % 4 == 2) {
      static_cast<void>(on_device.particles());
    }
    const MomentumOfNodes found = on_device.momentum_of_nodes(), expected = on_cpu.momentum_of_nodes();
    ASSERT_EQ(found.blocks, expected.blocks) << "after step " << k;
    ASSERT_EQ(found.records, expected.records) << "after step " << k;
  }
}
TEST(DeviceRunWithCaller, GivesTheMomentumOfTheNodes) {
  expect_the_same_momentum<2>(30);
  expect_the_same_momentum<3>(12);
}

}  // namespace
}  // namespace thawslide::sim
