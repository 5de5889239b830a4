#include "steps.hpp"

#include <fmt/format.h>
#include <malloc.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <numeric>
#include <unordered_map>

#include "base/parallel.hpp"
#include "base/thread_choice.hpp"
#include "config/read_case.hpp"
#include "machine.hpp"
#include "sim/simulation.hpp"

namespace thawslide::speed {

namespace {

// Case with every mechanism of the paper; cells of 1 m with 2 particles per axis.
constexpr const char* full_model = R"(
[case]
dimension = {dimension}
gravity_tilt = 40.0
[time]
end = 1e6
step = 0.002
[grid]
cell = 1.0
min = {min}
max = {max}
[terrain]
type = "flat"
elevation = 0.0
[material.debris]
law = "mohr_coulomb"
youngs_modulus = 2e8
poisson_ratio = 0.3
friction_angle = 35.0
cohesion = {cohesion}
hydraulic_conductivity = 1e-9
[body.slab]
material = "debris"
min = {low}
max = {high}
temperature = {temperature}
porosity = 0.375
[basal]
friction = "lubricated"
friction_angle = 30.0
[band]
thickness = 0.1
)";

std::string point(const StepCase& which, double x, double y, double z) {
  return which.dimension == 2 ? fmt::format("[{}, {}]", x, z) : fmt::format("[{}, {}, {}]", x, y, z);
}

config::Case make_case(const StepCase& which) {
  constexpr double margin = 8;
  const double end = (which.length + 10 * margin) * which.box;
  const std::string text = fmt::format(
      fmt::runtime(full_model), fmt::arg("dimension", which.dimension),
      fmt::arg("min", point(which, -margin, -margin, -margin)),
      fmt::arg("max", point(which, end, which.width + margin, which.height + 2 * margin)),
      fmt::arg("low", point(which, 0, 0, 0)), fmt::arg("high", point(which, which.length, which.width, which.height)),
      fmt::arg("cohesion", which.cohesion), fmt::arg("temperature", which.temperature));
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("thawslide-speed-{}", getpid());
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "case.toml") << text;
  config::Case parameters = config::read_case(folder);
  std::filesystem::remove_all(folder);
  return parameters;
}

double heap_in_use() {
  const auto heap = mallinfo2();
  return static_cast<double>(heap.uordblks + heap.hblkhd);
}

// A process that occupies the first core available to this process, for the lifetime of this object.
class BusyCore {
 public:
  explicit BusyCore(bool wanted) {
    if (!wanted) {
      return;
    }
    process_ = fork();
    if (process_ == 0) {
      cpu_set_t usable, first;
      CPU_ZERO(&first);
      sched_getaffinity(0, sizeof usable, &usable);
      for (int core = 0; CPU_COUNT(&first) == 0; ++core) {
        if (CPU_ISSET(core, &usable)) {
          CPU_SET(core, &first);
        }
      }
      if (sched_setaffinity(0, sizeof first, &first) != 0) {
        _exit(1);
      }
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      for (std::atomic<std::uint64_t> turns{0};; ++turns) {
      }
    }
  }
  ~BusyCore() {
    if (process_ > 0) {
      kill(process_, SIGKILL);
      waitpid(process_, nullptr, 0);
    }
  }
  BusyCore(const BusyCore&) = delete;
  BusyCore& operator=(const BusyCore&) = delete;

 private:
  pid_t process_ = -1;
};

double median(std::vector<double> numbers) {
  std::sort(numbers.begin(), numbers.end());
  const std::size_t half = numbers.size() / 2;
  return numbers.size() % 2 == 1 ? numbers[half] : (numbers[half - 1] + numbers[half]) / 2;
}

// Plastic strains by id.
template <int Dim>
std::unordered_map<std::int64_t, double> plastic_strains(const mpm::Particles<Dim>& particles) {
  std::unordered_map<std::int64_t, double> strains(particles.size());
  for (std::size_t p = 0; p < particles.size(); ++p) {
    strains.emplace(particles.id(p), particles.plastic_strain(p));
  }
  return strains;
}

// Fraction of particles that yield in one more step; particles that leave in it do not count.
template <int Dim, class Step>
double yielding_fraction(const mpm::Particles<Dim>& particles, const Step& step) {
  const auto before = plastic_strains(particles);
  step();
  const auto after = plastic_strains(particles);
  std::size_t yielded = 0;
  for (const auto& [id, strain] : after) {
    const auto known = before.find(id);
    yielded += known != before.end() && strain > known->second ? 1 : 0;
  }
  return static_cast<double>(yielded) / static_cast<double>(before.size());
}

template <int Dim>
StepTiming time_simulation(const StepCase& which, int threads, int repeats, double particle_steps) {
  using Clock = std::chrono::steady_clock;
  const double heap_before = heap_in_use();
  sim::Simulation<Dim> simulation(make_case(which));
  const auto& particles = simulation.particles();
  const auto count = static_cast<double>(particles.size());
  const double dt = simulation.parameters().time.step;
  double aside = 0;  // spent on parts that are not timed
  const auto clock = [&, start = Clock::now()] {
    return std::chrono::duration<double>(Clock::now() - start).count() - aside;
  };
  ThreadChoice choice(threads, clock());
  const auto step = [&] {
    simulation.step(dt);
    if (which.next_to_busy) {  // as in a run; other cases measure a fixed number of threads
      set_thread_count(choice.after_step(clock()));
    }
  };
  constexpr int warm_up = 4;
  for (int k = 0; k < warm_up; ++k) {
    step();
  }
  const BusyCore busy(which.next_to_busy);
  std::vector<double> rates, ticks, yielding;
  std::map<std::string, std::vector<double>> stages;
  const auto batch = std::max<std::int64_t>(2, static_cast<std::int64_t>(particle_steps / count));
  for (int r = 0; r < repeats; ++r) {
    const double frequency_before = clock_speed();
    const auto stages_before = simulation.stopwatch().seconds();
    const double start = clock();
    for (std::int64_t k = 0; k < batch; ++k) {
      step();
    }
    const double end = clock(), steps = count * static_cast<double>(batch);
    for (const auto& [stage, total] : simulation.stopwatch().seconds()) {
      stages[stage].push_back(1e9 * (total - stages_before.at(stage)) / steps);
    }
    rates.push_back(steps / (end - start));
    ticks.push_back((end - start) / steps * 1e9 * (frequency_before + clock_speed()) / 2);
    yielding.push_back(yielding_fraction(particles, [&] { simulation.step(dt); }));
    aside += clock() - end;
  }
  StepTiming timing{.name = which.name,
                    .particles = particles.size(),
                    .threads = threads,
                    .particle_steps_per_second = median(rates),
                    .lowest = *std::min_element(rates.begin(), rates.end()),
                    .highest = *std::max_element(rates.begin(), rates.end()),
                    .ticks = median(ticks),
                    .fewest_ticks = *std::min_element(ticks.begin(), ticks.end()),
                    .yielding = std::accumulate(yielding.begin(), yielding.end(), 0.0) / repeats,
                    .bytes_per_particle = (heap_in_use() - heap_before) / count,
                    .stages = {}};
  for (const auto& [stage, nanoseconds] : stages) {
    timing.stages.emplace_back(stage, median(nanoseconds));
  }
  return timing;
}

}  // namespace

std::vector<StepCase> step_cases() {
  std::vector<StepCase> cases{{"2D 8,400", 2, 210, 1, 10},
                              {"2D 100,000", 2, 2500, 1, 10},
                              {"2D 1,000,000", 2, 12500, 1, 20},
                              {"3D 8,000", 3, 20, 10, 5, 1, 6e5},
                              {"3D 100,000", 3, 50, 25, 10},
                              {"3D 1,000,000", 3, 125, 100, 10},
                              {"3D 100,000 yielding", 3, 50, 25, 10, 1, 4.0e4},
                              {"2D 100,000 thawed", 2, 2500, 1, 10, 1, 5e5, 1},
                              {"3D 100,000 thawed", 3, 50, 25, 10, 1, 5e5, 1},
                              {"2D 100,000 in a box 10 times as long", 2, 2500, 1, 10, 10},
                              {"2D 100,000 in a box 100 times as long", 2, 2500, 1, 10, 100}};
  for (StepCase which : {cases[0], cases[1]}) {
    which.name += ", next to a busy process";
    which.next_to_busy = true;
    cases.push_back(which);
  }
  return cases;
}

StepTiming time_steps(const StepCase& which, int threads, int repeats, double particle_steps) {
  set_thread_count(threads);
  return which.dimension == 2 ? time_simulation<2>(which, threads, repeats, particle_steps)
                              : time_simulation<3>(which, threads, repeats, particle_steps);
}

nlohmann::ordered_json to_json(const StepTiming& timing) {
  nlohmann::ordered_json json{{"case", timing.name},         {"particles", timing.particles},
                              {"threads", timing.threads},   {"particle_steps_per_s", timing.particle_steps_per_second},
                              {"lowest", timing.lowest},     {"highest", timing.highest},
                              {"ticks", timing.ticks},       {"fewest_ticks", timing.fewest_ticks},
                              {"yielding", timing.yielding}, {"bytes_per_particle", timing.bytes_per_particle}};
  for (const auto& [stage, nanoseconds] : timing.stages) {
    json["stages_ns"][stage] = nanoseconds;
  }
  return json;
}

}  // namespace thawslide::speed
