// Runs on the CPU emulation of the GPU backend, for tests.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "../../device/emulated.hpp"
#include "../support/fields.hpp"
#include "../support/two_bodies.hpp"
#include "band/basal_segments.hpp"
#include "base/error.hpp"
#include "sim/records/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

using namespace testing_support;
using device::Host, device::ThreadOrder;

// Threads of the emulation: their order, the size of their groups (0: as requested), and the number of steps after
// which particles are sorted in memory (0: never).
struct Threads {
  ThreadOrder order = ThreadOrder::shuffled;
  std::size_t group = 0;
  int sorting_interval = 32;
};

template <int Dim>
device::SolverFactory<Dim> emulated_gpu(const Threads& threads) {
  return device::emulated<Dim>(threads.order, threads.group);
}

// Forwards all calls to another solver; tests override some of them.
template <int Dim>
class ForwardingSolver : public device::Solver<Dim> {
 public:
  explicit ForwardingSolver(std::unique_ptr<device::Solver<Dim>> steps) : steps_(std::move(steps)) {}

  device::StepSums<Dim> step(double time, double dt, const terrain::StrengthLaw* strength) override {
    return steps_->step(time, dt, strength);
  }
  band::StepExtremes extremes() override { return steps_->extremes(); }
  device::AnySums<Dim> reduce(const device::AnyReduction<Dim>& reduction) override { return steps_->reduce(reduction); }
  const band::MapSample* sample_map(const mpm::MapCells& cells) override { return steps_->sample_map(cells); }
  mpm::PathSample front(const mpm::Transformation<Dim>& path, double mass) override {
    return steps_->front(path, mass);
  }
  std::vector<Vector<double, Dim>> escaped_positions() override { return steps_->escaped_positions(); }
  void copy_momentum_to(std::vector<std::uint64_t>& blocks, std::vector<double>& records) override {
    steps_->copy_momentum_to(blocks, records);
  }
  void sort_in_memory() override { steps_->sort_in_memory(); }
  void copy_to(const mpm::ParticleView<Dim>& particles) override { steps_->copy_to(particles); }
  [[nodiscard]] band::SegmentsState<Dim> segments() const override { return steps_->segments(); }
  band::BaseTotals base_totals() override { return steps_->base_totals(); }
  void time_stages() override {}
  [[nodiscard]] std::map<std::string, double> seconds() const override { return {}; }

 private:
  std::unique_ptr<device::Solver<Dim>> steps_;
};

// Counts how often particles are copied back.
template <int Dim>
class CopyCountingSolver final : public ForwardingSolver<Dim> {
 public:
  CopyCountingSolver(std::unique_ptr<device::Solver<Dim>> steps, int& copies)
      : ForwardingSolver<Dim>(std::move(steps)), copies_(copies) {}

  void copy_to(const mpm::ParticleView<Dim>& particles) override {
    ++copies_;
    ForwardingSolver<Dim>::copy_to(particles);
  }

 private:
  int& copies_;
};
template <int Dim>
device::SolverFactory<Dim> counting_copies(const Threads& threads, int& copies) {
  return [threads, &copies](const auto& model, const auto& particles, std::size_t count, auto callbacks) {
    return std::make_unique<CopyCountingSolver<Dim>>(
        emulated_gpu<Dim>(threads)(model, particles, count, std::move(callbacks)), copies);
  };
}

template <int Dim>
config::Case sliding_bodies(const Sets& more = {}) {
  return two_bodies<Dim>(2e4, 3.0, 3.0, 12.0, more);
}

template <int Dim>
void expect_the_same_particles(const Simulation<Dim>& found, const Simulation<Dim>& expected) {
  const auto numbers = fields_by_id(found.particles());
  for (const auto& [name, of_cpu] : fields_by_id(expected.particles())) {
    ASSERT_EQ(numbers.at(name).size(), of_cpu.size()) << name;
    EXPECT_EQ(std::memcmp(numbers.at(name).data(), of_cpu.data(), of_cpu.size() * sizeof(double)), 0) << name;
  }
}

template <int Dim>
std::string error_of(Simulation<Dim>& simulation) {
  try {
    for (int k = 0; k < 200; ++k) {
      simulation.step(0.002);
    }
  } catch (const RunError& error) {
    return error.what();
  }
  return "";
}

inline const Sets on_columns =
    "band.model=columns; band.column_step=0.004; band.thickness_change=conserving; body.right.material=frozen; "
    "body.right.temperature=-0.5; heat.advection_form=conservative; pressure.frozen=none; pressure.frozen_rows=sealed; "
    "pressure.melt_contraction=true";

// Sums over the last step and over all steps.
template <int Dim>
std::vector<double> sums_of(const Simulation<Dim>& simulation) {
  const terrain::ContactWork<Dim>& contact = simulation.contact();
  const Budget<Dim>& budget = simulation.budget();
  std::vector<double> sums{contact.friction_work, contact.loss,          contact.damping,      contact.node_kinetic,
                           contact.area,          contact.friction_area, contact.shear_force,  budget.friction_heat,
                           budget.boundary_heat,  budget.advection,      budget.capacity_heat, budget.band_rescale,
                           budget.drained_water,  budget.drained_heat,   budget.vented_water};
  for (const auto& vector : {contact.force, contact.constraint_impulse}) {
    sums.insert(sums.end(), vector.begin(), vector.end());
  }
  return sums;
}

// Sums, the bed and band columns.
template <int Dim>
void expect_the_same_step(const Simulation<Dim>& found, const Simulation<Dim>& expected) {
  EXPECT_EQ(found.time(), expected.time());
  EXPECT_EQ(sums_of(found), sums_of(expected));
  if (expected.bed() != nullptr) {
    EXPECT_EQ(found.bed()->state(), expected.bed()->state());
  }
  if (expected.band_columns() != nullptr) {
    const band::BaseSums sums = found.base_totals().sums, sums_on_cpu = expected.base_totals().sums;
    EXPECT_EQ(std::memcmp(&sums, &sums_on_cpu, sizeof(sums)), 0);
    EXPECT_EQ(band::numbers_of(*found.band_columns()), band::numbers_of(*expected.band_columns()));
  }
}

// Returns how often particles were copied back from the device before they were requested.
template <int Dim>
int expect_the_same_run(const config::Case& parameters, int steps, const config::Site& site = {},
                        const Threads& threads = {}) {
  Simulation<Dim> on_cpu(parameters, site), on_device(parameters, site);
  int copies = 0;
  on_device.use_device("a GPU", counting_copies<Dim>(threads, copies));
  on_device.set_sorting_interval(threads.sorting_interval);
  for (int k = 0; k < steps && !testing::Test::HasFailure(); ++k) {
    SCOPED_TRACE(fmt::format("step {}", k));
    on_cpu.step(on_cpu.next_step(10.0));
    on_device.step(on_device.next_step(10.0));
    expect_the_same_step(on_device, on_cpu);
  }
  const int copies_of_steps = copies;
  EXPECT_TRUE(on_cpu.bed() == nullptr || on_cpu.particle_count() > on_cpu.particles_at_start());
  EXPECT_EQ(on_device.removed().left, on_cpu.removed().left);
  const auto expected = history_row(on_cpu), found = history_row(on_device);
  EXPECT_EQ(copies, copies_of_steps) << "a row copies particles back";
  EXPECT_EQ(on_device.step_limit().step, on_cpu.step_limit().step);  // of particles in their final positions
  expect_the_same_particles(on_device, on_cpu);
  EXPECT_EQ(found.size(), expected.size());
  const auto unit_of = [](const std::string& name) { return name.substr(name.rfind('_') + 1); };
  std::map<std::string, double> largest;
  for (const auto& [name, value] : expected) {
    largest[unit_of(name)] =
        std::isnan(value) ? largest[unit_of(name)] : std::max(largest[unit_of(name)], std::abs(value));
  }
  for (std::size_t k = 0; k < found.size(); ++k) {
    // After particles have been added or removed, sums use their current positions, not those at the beginning of the
    // step: they differ by round-off.
    EXPECT_EQ(std::isnan(found[k].second), std::isnan(expected[k].second)) << found[k].first;
    if (std::isnan(expected[k].second)) {
      continue;
    }
    EXPECT_NEAR(found[k].second, expected[k].second, 1e-12 * largest.at(unit_of(found[k].first))) << found[k].first;
  }
  return copies_of_steps;
}

inline void expect_the_same_settling(const Sets& more) {
  const config::Case parameters = sliding_bodies<2>(
      more + "mechanics.initial_stress=settle; mechanics.settle_time=0.1; mechanics.settle_damping=5");
  Simulation<2> on_cpu(parameters), on_device(parameters);
  int copies = 0;
  on_device.use_device("a GPU", counting_copies<2>({}, copies));
  EXPECT_TRUE(on_cpu.settle() && on_device.settle());
  EXPECT_TRUE(on_device.momentum_of_nodes().blocks.empty());
  EXPECT_EQ(copies, 1);
  EXPECT_EQ(on_device.time(), 0.0);
  expect_the_same_particles(on_device, on_cpu);
  for (int k = 0; k < 20; ++k) {
    on_cpu.step(0.002);
    on_device.step(0.002);
  }
  expect_the_same_particles(on_device, on_cpu);
}

// Number of steps until the first particle leaves the domain.
inline int steps_until_one_leaves(const config::Case& parameters) {
  Simulation<2> simulation(parameters);
  while (simulation.removed().left == 0) {
    simulation.step(0.002);
  }
  return static_cast<int>(simulation.step_number());
}

}  // namespace thawslide::sim
