// Time loop of a run from its present time to its end, with output, progress and a final summary.
#pragma once

#include "app/run_output.hpp"

namespace thawslide::app {

// Settles a new run if requested, writes its first state and runs it; otherwise as run_to_end.
template <int Dim>
int start_and_run(sim::Simulation<Dim>& simulation, RunOutput<Dim>& output, const std::filesystem::path& folder);

// Returns the exit code: done, stopped by a signal, or not written. In each case, all results so far have been written.
// Throws RunError if the run failed.
template <int Dim>
int run_to_end(sim::Simulation<Dim>& simulation, RunOutput<Dim>& output, const std::filesystem::path& folder);

// Calls work(dimension constant) for the case's dimension.
template <class Work>
int with_dimension(int dimension, const Work& work) {
  return dimension == 2 ? work(std::integral_constant<int, 2>{}) : work(std::integral_constant<int, 3>{});
}

// Default output folder.
[[nodiscard]] std::filesystem::path usual_run_folder(const config::Case& parameters);

// Sets the number of threads; 0: all available cores.
void use_threads(int threads);

}  // namespace thawslide::app
