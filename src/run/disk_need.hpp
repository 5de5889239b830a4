// Estimate of the disk space of a run, and comparison with the free space.
#pragma once

#include <filesystem>
#include <string>

#include "sim/maps/flow_maps.hpp"
#include "sim/simulation.hpp"

namespace thawslide::run {

// Sizes in [bytes], without compression.
struct DiskNeed {
  double snapshots = 0.0, snapshot = 0.0;    // number, and size of one
  double checkpoint = 0.0;                   // of one, after the slide has spread (sim::usual_spread)
  double history_rows = 0.0, history = 0.0;  // number of rows, and size of all
  double maps = 0.0, inputs = 0.0;

  static constexpr double checkpoints = 3.0;  // two, and the one being written
  [[nodiscard]] double total() const {
    return snapshots * snapshot + checkpoints * checkpoint + history + maps + inputs;
  }
};

// maps: null in 2D; steps: expected number of steps of the run.
template <int Dim>
[[nodiscard]] DiskNeed disk_need(const sim::Simulation<Dim>& simulation, const sim::FlowMaps* maps, double steps);

// Free bytes on the disk of a folder, which need not exist yet.
[[nodiscard]] double free_on_disk(const std::filesystem::path& folder);

// Warning if a run would fill the disk; empty if there is space.
[[nodiscard]] std::string warning_of_disk(const config::Case& parameters, const DiskNeed& need, double free,
                                          const std::filesystem::path& folder);

}  // namespace thawslide::run
