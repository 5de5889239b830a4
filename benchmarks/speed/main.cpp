// Measures the speed of the step: whole steps and their stages, kernels, the machine. Prints a table; --json writes it
// to a file. ticks: elapsed ticks of the core's clock per particle and step.
//   speed [--filter TEXT] [--threads 1,2] [--repeats N] [--particle-steps N] [--without-machine] [--json FILE]
//   speed --kernels
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

struct Options {
  std::string filter, json_file;
  std::vector<int> threads{1, available_cores()};
  int repeats = 5;
  double particle_steps = 2e6;
  bool kernels = false, without_machine = false;
};

void declare(CLI::App& app, Options& options) {
  auto* kernels = app.add_flag("--kernels", options.kernels, "Time single functions instead; prints only");
  const auto of_steps = [&](CLI::Option* option) { return option->excludes(kernels); };
  of_steps(
      app.add_option("--filter", options.filter, "Only the case of this name, or those whose names begin with it"));
  of_steps(app.add_option("--threads", options.threads, "Thread counts"))->delimiter(',')->check(CLI::Range(1, 1024));
  of_steps(app.add_option("--repeats", options.repeats, "Batches of steps, of which the median counts"))
      ->check(CLI::Range(1, 1000));
  of_steps(
      app.add_option("--particle-steps", options.particle_steps, "Length of a batch: the same work on any machine"))
      ->check(CLI::PositiveNumber);
  of_steps(app.add_option("--json", options.json_file, "File for the numbers"));
  of_steps(app.add_flag("--without-machine", options.without_machine, "Leave out what the machine can do at best"));
}

std::vector<StepCase> chosen_cases(const std::string& filter) {
  std::vector<StepCase> cases = step_cases();
  const bool is_name = std::any_of(cases.begin(), cases.end(), [&](const StepCase& c) { return c.name == filter; });
  std::erase_if(cases, [&](const StepCase& c) { return is_name ? c.name != filter : c.name.rfind(filter, 0) != 0; });
  if (cases.empty()) {
    throw UserError(fmt::format("--filter: no case is called '{}' or begins with it; without it all are run", filter));
  }
  return cases;
}

void print_limits(const MachineLimits& limits) {
  fmt::print("machine: {:.2f} GHz now; {:.0f} GFLOP/s multiply-add a core; ", limits.clock, limits.multiply_add);
  fmt::print("triad {:.0f} GB/s in cache, {:.1f} from memory, {:.1f} on {} threads\n\n", limits.triad_cache,
             limits.triad_memory, limits.triad_threads, available_cores());
}

void print_timing(const StepTiming& timing) {
  fmt::print("{:<40} {:>9} {:>7} {:>8.2f} {:>6.2f}-{:<6.2f} {:>6.0f} {:>5.0f} {:>6.1f} {:>8.0f}\n", timing.name,
             timing.particles, timing.threads, timing.particle_steps_per_second / 1e6, timing.lowest / 1e6,
             timing.highest / 1e6, timing.ticks, timing.fewest_ticks, 100 * timing.yielding, timing.bytes_per_particle);
  std::fflush(stdout);
}

// Only for cases of 100,000 particles on one thread, without the variants of the box and the busy core.
void print_stages(const StepTiming& timing) {
  const auto is_of = [&](const char* text) { return timing.name.find(text) != std::string::npos; };
  if (timing.threads != 1 || !is_of("100,000") || is_of("box") || is_of("busy")) {
    return;
  }
  auto stages = timing.stages;
  std::sort(stages.begin(), stages.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  fmt::print("\nstages of {} on {} thread(s), ns a particle and step\n", timing.name, timing.threads);
  for (const auto& [stage, nanoseconds] : stages) {
    fmt::print("  {:<30} {:>8.1f}\n", stage, nanoseconds);
  }
}

void time_cases(const Options& options) {
  const std::vector<StepCase> cases = chosen_cases(options.filter);
  nlohmann::ordered_json json;
  if (!options.without_machine) {
    const MachineLimits limits = measure_machine(available_cores());
    print_limits(limits);
    json["machine"] = to_json(limits);
  }
  fmt::print("{:<40} {:>9} {:>7} {:>8} {:>13} {:>6} {:>5} {:>6} {:>8}\n", "case", "particles", "threads", "M p-st/s",
             "range", "ticks", "least", "% yld", "B/part");
  std::vector<StepTiming> timings;
  for (const StepCase& which : cases) {
    for (const int count : options.threads) {
      timings.push_back(time_steps(which, count, options.repeats, options.particle_steps));
      print_timing(timings.back());
      json["steps"].push_back(to_json(timings.back()));
    }
  }
  std::for_each(timings.begin(), timings.end(), print_stages);
  if (!options.json_file.empty() && !(std::ofstream(options.json_file) << json.dump(2) << "\n").flush()) {
    throw UserError(fmt::format("--json: cannot write {}", options.json_file));
  }
}

}  // namespace

int main(int argc, char** argv) try {
  set_passive_wait(argv);
  CLI::App app{"Speed of the step"};
  Options options;
  declare(app, options);
  CLI11_PARSE(app, argc, argv);
  if (options.kernels) {
    int none = 1;
    benchmark::Initialize(&none, argv);
    add_kernels();
    benchmark::RunSpecifiedBenchmarks();
  } else {
    time_cases(options);
  }
  return 0;
} catch (const UserError& error) {
  fmt::print(stderr, "{}\n", error.what());
  return 2;
}
