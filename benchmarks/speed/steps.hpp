// Timing of complete steps of the full model.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace thawslide::speed {

// A slab that slides down 40 degrees with every mechanism enabled.
struct StepCase {
  std::string name;
  int dimension;
  double length, width, height;  // of the slab, in cells of 1 m
  double box = 1;                // length of the domain over the length needed by the slab
  double cohesion = 5e5;         // inside the slab [Pa]: a smaller value increases the yielding fraction
  double temperature = -1;       // initial [C]: above 0 water seeps everywhere, below 0 nowhere before melting
  bool next_to_busy = false;     // another process keeps one core busy
};

struct StepTiming {
  std::string name;
  std::size_t particles;
  int threads;
  double particle_steps_per_second;  // median over repeats
  double lowest, highest;            // over repeats
  double ticks, fewest_ticks;        // per particle and step, for any threads: median and minimum over repeats
  double yielding;                   // fraction of particles that yield, mean over repeats
  double bytes_per_particle;         // heap in use after the run, over the number of particles
  std::vector<std::pair<std::string, double>> stages;  // [ns per particle and step], medians over repeats
};

std::vector<StepCase> step_cases();

// Measures `repeats` batches of steps, each of about `particle_steps` and at least two steps, so that the timed work
// does not depend on the machine.
StepTiming time_steps(const StepCase& which, int threads, int repeats, double particle_steps);

nlohmann::ordered_json to_json(const StepTiming& timing);

}  // namespace thawslide::speed
