// Summary at the end of a run.
#pragma once

#include <cstdint>
#include <filesystem>

#include "app/run_output.hpp"

namespace thawslide::app {

// Prints throughput, time of each stage and position of the slide; steps, wall [s]: of this process.
template <int Dim>
void print_summary(const sim::Simulation<Dim>& simulation, const RunOutput<Dim>& output, std::int64_t steps,
                   double wall, const std::filesystem::path& folder);

}  // namespace thawslide::app
