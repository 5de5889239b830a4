#include "run/run_cost.hpp"

#include <algorithm>
#include <cmath>

#include "base/clocks.hpp"
#include "base/error.hpp"
#include "base/instances.hpp"
#include "base/parallel.hpp"
#include "base/rounding.hpp"
#include "device/gpu.hpp"
#include "sim/memory_need.hpp"

namespace thawslide::run {

namespace {

constexpr double enough_seconds = 0.5;
constexpr int enough_steps = 200;

// Cost of a run over that of its number of first steps. A slide that spreads touches more nodes and columns, and output
// is written. Measured on whole runs: 1.2 to 2.3 (plane, Lamplugh, entrainment), and with band columns 3.0 to 3.3
// (slope of the Alps, Lamplugh).
double spreading_factor(const config::Case& parameters) {
  const double of_splitting = std::min(sim::usual_cost_of_splitting, sim::splitting_factor(parameters));
  return of_splitting * (config::has_band_columns(parameters) ? 3.1 : 1.7);
}

// Calls step() for up to `enough_seconds` of a clock; returns the number of calls.
template <class Step, class Clock>
int repeat(const Step& step, const Clock& clock) {
  const double start = clock();
  int steps = 0;
  while (steps < enough_steps && clock() - start < enough_seconds && step()) {
    ++steps;
  }
  return std::max(steps, 1);
}

// Performs a step unless the run has ended, or all particles have left.
template <int Dim>
bool advance(sim::Simulation<Dim>& simulation) {
  const double end = simulation.parameters().time.end;
  if (simulation.time() >= end || !simulation.left_text().empty()) {
    return false;
  }
  simulation.step(simulation.next_step(end));
  return true;
}

}  // namespace

template <int Dim>
double steps_to_end(sim::Simulation<Dim>& simulation) {
  const config::Time& time = simulation.parameters().time;
  const double steps = time.end / simulation.next_step(time.end) * (1.0 - 1e-12);
  // Fixed steps may end the run up to half a step early; adaptive steps are cut to end exactly.
  return time.stepping == config::Stepping::fixed ? std::max(1.0, std::ceil(steps - 0.5)) : std::ceil(steps);
}

template <int Dim>
RunCost cost_on_cpu(sim::Simulation<Dim>& simulation, double steps) {
  const SingleThreadScope one_thread;
  const double wall = wall_clock(), processor = thread_clock();
  const int performed = repeat([&] { return advance(simulation); }, thread_clock);
  const double seconds = thread_clock() - processor;
  const double slowdown = (wall_clock() - wall) / seconds;
  return {steps, seconds / performed * steps * spreading_factor(simulation.parameters()), slowdown};
}

template <int Dim>
RunCost cost_on_device(sim::Simulation<Dim>& simulation, double steps) {
  const double wall = wall_clock();
  const int performed = repeat([&] { return advance(simulation); }, wall_clock);
  return {steps, (wall_clock() - wall) / performed * steps};
}

std::string text_of(const RunCost& cost) {
  constexpr double busy = 1.25;
  return fmt::format("{} of processor time{}", duration_text(cost.processor),
                     cost.slowdown < busy ? ""
                                          : fmt::format(" (this machine is busy: {} of wall-clock time on one thread)",
                                                        duration_text(cost.slowdown * cost.processor)));
}

#define THAWSLIDE_INSTANTIATE(Dim)                                  \
  template double steps_to_end<Dim>(sim::Simulation<Dim>&);         \
  template RunCost cost_on_cpu<Dim>(sim::Simulation<Dim>&, double); \
  template RunCost cost_on_device<Dim>(sim::Simulation<Dim>&, double);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

GpuFacts detect_gpu() {
  const device::Gpu gpu = device::find_gpu();
  return {gpu.name, gpu.unavailable_reason, gpu.free, 0.0, 0.0};
}

template <int Dim>
std::string use_device(const std::string& device, sim::Simulation<Dim>& simulation) {
  if (device == "cpu") {
    return "";
  }
  if (device != "gpu" && device != "auto") {
    throw UserError("device is '{}'; allowed: cpu, gpu, auto.", device);
  }
  const device::Gpu gpu = device::find_gpu();
  if (!gpu.is_usable && device == "auto") {
    return "";
  }
  if (!gpu.is_usable) {
    throw UserError("--device gpu: {}. Run the case on the CPU: --device cpu", gpu.unavailable_reason);
  }
  simulation.use_device(gpu.name, device::on_gpu<Dim>());
  return gpu.name;
}

template std::string use_device<2>(const std::string&, sim::Simulation<2>&);
template std::string use_device<3>(const std::string&, sim::Simulation<3>&);

}  // namespace thawslide::run
