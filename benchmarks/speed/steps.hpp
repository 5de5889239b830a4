// Whole steps of the full model, timed.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace thawslide::speed {

// A slab that slides down 40 degrees with every mechanism on.
struct StepCase {
  std::string name;
  int dimension;
  double length, width, height;  // of the slab, in cells of 1 m
  double box = 1;                // the domain is this many times as long as the slab's needs it to be
  double cohesion = 5e5;         // inside the slab [Pa]: the smaller, the more of it yields
  double temperature = -1;       // at first [C]: above 0 water seeps everywhere, below as long as nothing melts nowhere
  bool beside_busy = false;      // another process keeps one core busy
};

struct StepTiming {
  std::string name;
  std::size_t particles;
  int threads;
  double particle_steps_per_second;  // median over repeats
  double lowest, highest;            // over repeats
  double ticks, fewest_ticks;  // that pass a particle and step, whatever the threads: median and least over repeats
  double yielding;             // share of particles that yield, mean over repeats
  double bytes_per_particle;   // heap in use after the run over particles
  std::vector<std::pair<std::string, double>> stages;  // [ns per particle and step], medians over repeats
};

std::vector<StepCase> step_cases();

// Times `repeats` batches of steps, each of about `particle_steps` and of two steps at least, so that what is timed
// does not depend on the machine.
StepTiming time_steps(const StepCase& which, int threads, int repeats, double particle_steps);

nlohmann::ordered_json to_json(const StepTiming& timing);

}  // namespace thawslide::speed
