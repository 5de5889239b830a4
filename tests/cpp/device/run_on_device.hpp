// Runs on the CPU emulation of the GPU backend, for tests.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "../../device/emulated.hpp"
#include "../support/fields.hpp"
#include "../support/two_bodies.hpp"
#include "base/error.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

using namespace testing_support;
using device::Host, device::ThreadOrder;

template <int Dim>
device::SolverFactory<Dim> emulated_gpu(ThreadOrder order) {
  return device::emulated<Dim>(order);
}

// Forwards all calls to another solver; tests override some of them.
template <int Dim>
class ForwardingSolver : public device::Solver<Dim> {
 public:
  explicit ForwardingSolver(std::unique_ptr<device::Solver<Dim>> steps) : steps_(std::move(steps)) {}

  device::StepSums<Dim> step(double time, double dt) override { return steps_->step(time, dt); }
  mpm::MonitorSums monitor(const mpm::MonitorKernel<Dim>& kernel) override { return steps_->monitor(kernel); }
  void sample_map(const mpm::MapCells& cells, device::MapSample& sample) override { steps_->sample_map(cells, sample); }
  band::BodySums<Dim> sum_over_body(const band::SumsOfParticle<Dim>& of_particle) override {
    return steps_->sum_over_body(of_particle);
  }
  mpm::PathSample front(const mpm::Transformation<Dim>& path, double mass) override {
    return steps_->front(path, mass);
  }
  std::vector<Vector<double, Dim>> escaped_positions() override { return steps_->escaped_positions(); }
  void sort_in_memory() override { steps_->sort_in_memory(); }
  void copy_to(const mpm::ParticleView<Dim>& particles) override { steps_->copy_to(particles); }
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
device::SolverFactory<Dim> counting_copies(ThreadOrder order, int& copies) {
  return [order, &copies](const auto& model, const auto& particles, std::size_t count, auto callbacks) {
    return std::make_unique<CopyCountingSolver<Dim>>(
        emulated_gpu<Dim>(order)(model, particles, count, std::move(callbacks)), copies);
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

}  // namespace thawslide::sim
