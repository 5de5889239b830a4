// Measures the speed of the step: whole steps and their stages, kernels, the machine. Prints a table; --json keeps it.
// ticks: of the core's clock, a particle and step.
//   speed [--filter TEXT] [--threads 1,2] [--repeats N] [--particle-steps N] [--json FILE] [--kernels]
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "kernels.hpp"
#include "machine.hpp"
#include "steps.hpp"

namespace {

using namespace thawslide;
using namespace thawslide::speed;

void print_timing(const StepTiming& timing) {
  fmt::print("{:<40} {:>9} {:>7} {:>8.2f} {:>6.2f}-{:<6.2f} {:>6.0f} {:>5.0f} {:>6.1f} {:>8.0f}\n", timing.name,
             timing.particles, timing.threads, timing.particle_steps_per_second / 1e6, timing.lowest / 1e6,
             timing.highest / 1e6, timing.ticks, timing.fewest_ticks, 100 * timing.yielding, timing.bytes_per_particle);
  std::fflush(stdout);
}

void print_stages(const StepTiming& timing) {
  auto stages = timing.stages;
  std::sort(stages.begin(), stages.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  fmt::print("\nstages of {} on {} thread(s), ns a particle and step\n", timing.name, timing.threads);
  for (const auto& [stage, nanoseconds] : stages) {
    fmt::print("  {:<30} {:>8.1f}\n", stage, nanoseconds);
  }
}

}  // namespace

int main(int argc, char** argv) try {
  let_threads_wait_passively(argv);
  CLI::App app{"Speed of the step"};
  std::string filter, json_file;
  std::vector<int> threads{1, available_cores()};
  int repeats = 5;
  double particle_steps = 2e6;
  bool kernels = false;
  app.add_option("--filter", filter, "Only the case of this name, or those whose names begin with it");
  app.add_option("--threads", threads, "Thread counts")->delimiter(',')->check(CLI::Range(1, 1024));
  app.add_option("--repeats", repeats, "Batches of steps, of which the median counts")->check(CLI::Range(1, 1000));
  app.add_option("--particle-steps", particle_steps, "Length of a batch: the same work on any machine")
      ->check(CLI::PositiveNumber);
  app.add_option("--json", json_file, "File for the numbers");
  app.add_flag("--kernels", kernels, "Time single functions instead");
  CLI11_PARSE(app, argc, argv);
  if (kernels) {
    int none = 1;
    benchmark::Initialize(&none, argv);
    add_kernels();
    benchmark::RunSpecifiedBenchmarks();
    return 0;
  }
  const MachineLimits limits = measure_machine(available_cores());
  fmt::print(
      "machine: {:.2f} GHz now; {:.0f} GFLOP/s multiply-add a core; triad {:.0f} GB/s in cache, {:.1f} from memory, "
      "{:.1f} on {} "
      "threads\n\n",
      clock_speed(), limits.multiply_add, limits.triad_cache, limits.triad_memory, limits.triad_threads,
      available_cores());
  fmt::print("{:<40} {:>9} {:>7} {:>8} {:>13} {:>6} {:>5} {:>6} {:>8}\n", "case", "particles", "threads", "M p-st/s",
             "range", "ticks", "least", "% yld", "B/part");
  nlohmann::ordered_json json{{"machine", to_json(limits)}};
  std::vector<StepTiming> timings;
  const std::vector<StepCase> cases = step_cases();
  const bool is_name = std::any_of(cases.begin(), cases.end(), [&](const StepCase& c) { return c.name == filter; });
  for (const StepCase& which : cases) {
    if (is_name ? which.name != filter : which.name.rfind(filter, 0) != 0) {
      continue;
    }
    for (const int count : threads) {
      timings.push_back(time_steps(which, count, repeats, particle_steps));
      print_timing(timings.back());
      json["steps"].push_back(to_json(timings.back()));
    }
  }
  for (const StepTiming& timing : timings) {
    if (timing.threads == 1 && timing.name.find("100,000") != std::string::npos &&
        timing.name.find("box") == std::string::npos && timing.name.find("busy") == std::string::npos) {
      print_stages(timing);
    }
  }
  if (!json_file.empty()) {
    std::ofstream(json_file) << json.dump(2) << "\n";
  }
  return 0;
} catch (const UserError& error) {
  fmt::print(stderr, "{}\n", error.what());
  return 2;
}
