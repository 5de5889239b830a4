// Runs on a device that fail, or continue from a checkpoint.
#include <filesystem>
#include <utility>

#include "io/checkpoint.hpp"
#include "run_on_device.hpp"

namespace thawslide::sim {
namespace {

TEST(DeviceRun, FailsWithTheSameMessage) {
  const config::Case parameters = sliding_bodies<2>();
  Simulation<2> on_cpu(parameters), on_device(parameters);
  on_device.use_device("a GPU", emulated_gpu<2>({ThreadOrder::forward}));
  for (Simulation<2>* simulation : {&on_cpu, &on_device}) {
    for (std::size_t p = 0; p < simulation->particles().size(); ++p) {
      simulation->particles().velocity(p, 0) = -500.0;
    }
  }
  const std::string expected = error_of(on_cpu);
  EXPECT_NE(expected.find("left the domain"), std::string::npos) << expected;
  EXPECT_EQ(error_of(on_device), expected);
}

// Advances until it fails, or until particles are requested.
class FailingSolver final : public ForwardingSolver<2> {
 public:
  FailingSolver(std::unique_ptr<device::Solver<2>> steps, int steps_before_failure)
      : ForwardingSolver(std::move(steps)), left_(steps_before_failure) {}

  device::StepSums<2> step(double time, double dt, const terrain::StrengthLaw* strength) override {
    if (left_-- == 0) {
      throw device::Failure("allocating memory on the GPU: out of memory");
    }
    return ForwardingSolver::step(time, dt, strength);
  }
  void copy_to(const mpm::ParticleView<2>& /*particles*/) override {
    throw device::Failure("copying from the GPU: unspecified launch failure");
  }

 private:
  int left_;
};

device::SolverFactory<2> failing_gpu(int steps_before_failure) {
  return [steps_before_failure](const auto& model, const auto& particles, std::size_t count, auto callbacks) {
    return std::make_unique<FailingSolver>(
        emulated_gpu<2>({ThreadOrder::forward})(model, particles, count, std::move(callbacks)), steps_before_failure);
  };
}

// Runs on a device that fails after a number of steps. Returns the error message, and checks the remaining particles.
std::string reported_failure(int steps_before_failure, int steps) {
  Simulation<2> simulation(sliding_bodies<2>());
  const auto at_start = fields_by_id(simulation.particles());
  simulation.use_device("a GPU", failing_gpu(steps_before_failure));
  std::string message;
  try {
    for (int k = 0; k < steps; ++k) {
      simulation.step(0.002);
    }
    static_cast<void>(std::as_const(simulation).particles());
  } catch (const DeviceError& error) {
    message = error.what();
  }
  EXPECT_EQ(fields_by_id(std::as_const(simulation).particles()).at("position"), at_start.at("position"));
  return message;
}

TEST(DeviceRun, ReportsAFailingDevice) {
  EXPECT_EQ(reported_failure(3, 5), "a GPU failed at step 3: allocating memory on the GPU: out of memory");
  EXPECT_EQ(reported_failure(9, 5), "a GPU failed at step 5: copying from the GPU: unspecified launch failure");
}

// The same while a body settles.
TEST(DeviceRun, ReportsADeviceThatFailsWhileABodySettles) {
  Simulation<2> simulation(sliding_bodies<2>(
      {"mechanics.initial_stress=\"settle\"", "mechanics.settle_time=0.1", "mechanics.settle_damping=5.0"}));
  simulation.use_device("a GPU", failing_gpu(3));
  EXPECT_THROW(simulation.settle(), DeviceError);
}

// Continues from a checkpoint, on the CPU or on a device again.
void expect_continuation(const Sets& sets) {
  const config::Case parameters = sliding_bodies<2>(Sets("time.stepping=adaptive") + sets);
  Simulation<2> whole(parameters), first(parameters);
  for (Simulation<2>* simulation : {&whole, &first}) {
    simulation->use_device("a GPU", emulated_gpu<2>({ThreadOrder::forward}));
  }
  const auto advance = [](Simulation<2>& simulation, int steps) {
    for (int k = 0; k < steps; ++k) {
      simulation.step(simulation.next_step(10.0));
    }
  };
  advance(whole, 30);
  advance(first, 13);
  const std::filesystem::path folder = folder_of_this_test();
  io::write_checkpoint<2>(folder, std::as_const(first).particles(), first.particles_at_start(), first.scalars(), {},
                          "");
  for (const bool on_device : {false, true}) {
    Simulation<2> second(parameters);
    if (on_device) {
      second.use_device("a GPU", emulated_gpu<2>({ThreadOrder::backward}));
    }
    std::vector<double> numbers;
    io::read_checkpoint<2>(io::newest_checkpoint(folder), second.particles(), numbers);
    second.restore(numbers);
    advance(second, 17);
    EXPECT_EQ(second.time(), whole.time());
    expect_the_same_particles(second, whole);
  }
}
TEST(DeviceRun, ContinuesFromACheckpoint) {
  expect_continuation({});
  expect_continuation("body.left.release_time=0.01; body.left.velocity=[0,0]");  // before the first part
  expect_continuation("body.left.release_time=0.035; body.left.velocity=[0,0]");
}

}  // namespace
}  // namespace thawslide::sim
