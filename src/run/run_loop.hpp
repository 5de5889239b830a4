// Time loop of a run from its present time to its end, with output and reports to an observer.
#pragma once

#include "base/error.hpp"
#include "run/observer.hpp"
#include "run/run_output.hpp"

namespace thawslide::run {

// Settles a new run if requested, writes its first state and runs it; otherwise as run_to_end.
template <int Dim>
ExitCode start_and_run(sim::Simulation<Dim>& simulation, RunOutput<Dim>& output, const std::filesystem::path& folder,
                       Observer& observer);

// Returns why the run ended: done, interrupted, not written, or failure of the device. In each case, all results so far
// have been written. Throws RunError if the run failed.
template <int Dim>
ExitCode run_to_end(sim::Simulation<Dim>& simulation, RunOutput<Dim>& output, const std::filesystem::path& folder,
                    Observer& observer);

// Calls work(dimension constant) for the case's dimension.
template <class Work>
auto with_dimension(int dimension, const Work& work) {
  return dimension == 2 ? work(std::integral_constant<int, 2>{}) : work(std::integral_constant<int, 3>{});
}

// Default output folder.
[[nodiscard]] std::filesystem::path usual_run_folder(const config::Case& parameters);

// Sets the number of threads; 0: all available cores.
void use_threads(int threads);

}  // namespace thawslide::run
