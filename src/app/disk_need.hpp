// What a run will write, and whether the disk has room for it.
#pragma once

#include <filesystem>
#include <string>

#include "sim/flow_maps.hpp"
#include "sim/simulation.hpp"

namespace thawslide::app {

// [bytes], as if nothing could be compressed. What a checkpoint holds of maps and of columns of the base grows with the
// ground that the slide has been on: an allowance is made for that, sim::usual_spread.
struct DiskNeed {
  double snapshots = 0.0, snapshot = 0.0;      // how many, and one of them
  double checkpoints = 0.0, checkpoint = 0.0;  // with the one that is being written; once the slide has spread
  double checkpoint_at_start = 0.0;            // before it has
  double history_rows = 0.0, history = 0.0;    // how many rows, and all of them
  double maps = 0.0, map = 0.0;                // as the slide leaves them
  double ground_maps = 0.0, ground_map = 0.0;  // on the points of the DEM
  double inputs = 0.0;                         // copies

  [[nodiscard]] double total() const {
    return snapshots * snapshot + checkpoints * checkpoint + history + maps * map + ground_maps * ground_map + inputs;
  }
};

// maps: null in the plane; steps: as many as the run will take.
template <int Dim>
[[nodiscard]] DiskNeed disk_need(const sim::Simulation<Dim, double>& simulation, const sim::FlowMaps* maps,
                                 double steps);

// Free bytes where a folder is, or would be made.
[[nodiscard]] double free_on_disk(const std::filesystem::path& folder);

// What to say where a run would fill the disk; empty where there is room.
[[nodiscard]] std::string warning_of_disk(const config::Case& parameters, const DiskNeed& need, double free,
                                          const std::filesystem::path& folder);

}  // namespace thawslide::app
