// Summary at the end of a run.
#pragma once

#include <cstdint>
#include <filesystem>

#include "run/observer.hpp"
#include "run/run_output.hpp"

namespace thawslide::run {

// Reports throughput, position of the slide, key figures and warnings; steps, wall [s]: of this process.
template <int Dim>
void report_summary(const sim::Simulation<Dim>& simulation, const RunOutput<Dim>& output, std::int64_t steps,
                    double wall, const std::filesystem::path& folder, Observer& observer);

}  // namespace thawslide::run
