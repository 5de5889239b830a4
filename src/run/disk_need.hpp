// Estimate of the disk space of a run, and comparison with the free space.
#pragma once

#include <filesystem>
#include <string>

#include "sim/maps/flow_maps.hpp"
#include "sim/simulation.hpp"

namespace thawslide::run {

// Sizes in [bytes], without compression. Maps and basal columns in a checkpoint grow with the ground that the slide has
// covered; the allowance for this is sim::usual_spread.
struct DiskNeed {
  double snapshots = 0.0, snapshot = 0.0;      // number, and size of one
  double checkpoints = 0.0, checkpoint = 0.0;  // with the one being written; after the slide has spread
  double checkpoint_at_start = 0.0;            // before it has spread
  double history_rows = 0.0, history = 0.0;    // number of rows, and size of all
  double maps = 0.0, map = 0.0;                // at the end of the run
  double ground_maps = 0.0, ground_map = 0.0;  // on the points of the DEM
  double inputs = 0.0;                         // copies

  [[nodiscard]] double total() const {
    return snapshots * snapshot + checkpoints * checkpoint + history + maps * map + ground_maps * ground_map + inputs;
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
