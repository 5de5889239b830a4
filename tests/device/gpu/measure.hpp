// Speed and memory of steps of a 3D slide, by size.
#pragma once

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <new>
#include <vector>

#include "variants.hpp"

namespace thawslide::gpu_test {

struct Measured {
  std::size_t particles = 0;
  double yielding = 0;  // fraction of the particles, in the last step
  double seconds_a_step = 0;
  double seconds_of_row = 0;   // sums and front: delay due to a row of the history
  double seconds_of_copy = 0;  // copying all particles to the CPU: delay due to a snapshot or a checkpoint
  double memory = 0;           // of the device [bytes]
};

class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

// Size for approximately this number of particles: square base, height a quarter of the side.
inline Size size_of(std::size_t particles) {
  const double height = std::cbrt(static_cast<double>(particles) / 8.0 / 16.0);
  const auto cells = [](double number) { return static_cast<std::size_t>(std::max(1.0, std::round(number))); };
  return {cells(4 * height), cells(4 * height), cells(height)};
}

inline std::vector<double> plastic_strain_by_id(const ParticleMemory<3>& particles) {
  std::vector<double> strain(particles.size());
  for (std::size_t k = 0; k < strain.size(); ++k) {
    strain[static_cast<std::size_t>(particles.view().id(k) / 3)] = particles.view().plastic_strain(k);
  }
  return strain;
}

// free_memory: of the device, now [bytes]. stage: called with the name and the seconds per step of each stage, if
// given.
using ReportStage = std::function<void(const std::string&, double)>;
inline Measured measured(const device::SolverFactory<3>& make, std::size_t particles, Variant variant,
                         double seconds_at_least, const std::function<double()>& free_memory,
                         const ReportStage& stage = {}) {
  const Size size = size_of(particles);
  ParticleMemory<3> memory(size.particles(3));
  seed(size, memory);
  Measured found;
  found.particles = memory.size();
  const double free_before = free_memory();
  const auto steps = steps_of(make, memory, variant);
  int done = 0;
  const auto take = [&](int count) {
    for (const int last = done + count; done < last; ++done) {
      steps->step(done * time_step, time_step, nullptr);
    }
  };
  take(5);
  steps->sort_in_memory();
  take(5);
  steps->copy_to(memory.view());  // waits for all pending work
  const int first = done;
  const Stopwatch of_steps;
  do {
    take(10);
  } while (of_steps.seconds() < seconds_at_least && done < first + 200);
  found.seconds_a_step = of_steps.seconds() / (done - first);  // a step ends with sums for which the CPU waits
  found.memory = free_before - free_memory();
  const auto row = [&] { steps->front({}, std::get<band::BodySums<3>>(steps->reduce(sums_of_particle<3>())).mass); };
  row();  // allocates memory
  const Stopwatch of_row;
  row();
  found.seconds_of_row = of_row.seconds();
  const Stopwatch of_copy;
  steps->copy_to(memory.view());
  found.seconds_of_copy = of_copy.seconds();
  const std::vector<double> before = plastic_strain_by_id(memory);
  take(1);
  steps->copy_to(memory.view());
  const std::vector<double> after = plastic_strain_by_id(memory);
  for (std::size_t k = 0; k < after.size(); ++k) {
    found.yielding += after[k] > before[k] ? 1.0 / static_cast<double>(after.size()) : 0.0;
  }
  if (stage) {
    constexpr int timed = 20;
    steps->time_stages();
    take(timed);
    for (const auto& [name, spent] : steps->seconds()) {
      stage(name, spent / timed);
    }
  }
  return found;
}

inline void print_row(const Measured& found) {
  std::printf("| %zu | %.0f | %.4g | %.4g | %.3g | %.3g | %.3g |\n", found.particles, 100 * found.yielding,
              1e3 * found.seconds_a_step, static_cast<double>(found.particles) / found.seconds_a_step / 1e6,
              1e3 * found.seconds_of_row, 1e3 * found.seconds_of_copy, found.memory / 1024.0 / 1024.0 / 1024.0);
  std::fflush(stdout);
}

// Table of docs/how-to/run-on-a-gpu.md as Markdown: each size elastic and yielding, up to the first that does not
// fit in memory.
inline void print_table(const device::SolverFactory<3>& make, const std::vector<std::size_t>& sizes,
                        double seconds_at_least, const std::function<double()>& free_memory) {
  std::printf(
      "| particles | yielding [%%] | a step [ms] | million particle-steps a second | a row of the history [ms] | all "
      "particles to the CPU [ms] | memory [GiB] |\n|---|---|---|---|---|---|---|\n");
  for (const std::size_t particles : sizes) {
    for (const Variant variant : {Variant::elastic, Variant::plain}) {
      try {
        print_row(measured(make, particles, variant, seconds_at_least, free_memory));
      } catch (const device::Failure& failure) {
        std::printf("\n%zu particles: %s\n", particles, failure.what());
        return;
      } catch (const std::bad_alloc&) {
        std::printf("\n%zu particles: this machine's own memory does not hold them\n", particles);
        return;
      }
    }
  }
}

}  // namespace thawslide::gpu_test
