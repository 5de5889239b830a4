// What a run tells at its end.
#pragma once

#include <cstdint>
#include <filesystem>

#include "app/run_output.hpp"

namespace thawslide::app {

// Throughput, time of each stage and where the slide is; steps, wall [s]: of this process.
template <int Dim>
void print_summary(const sim::Simulation<Dim, double>& simulation, const RunOutput<Dim>& output, std::int64_t steps,
                   double wall, const std::filesystem::path& folder);

}  // namespace thawslide::app
