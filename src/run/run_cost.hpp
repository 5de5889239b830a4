// Estimated cost of a run, from its first steps, its disk space, and its device: --device.
#pragma once

#include <filesystem>
#include <limits>
#include <string>

#include "sim/maps/flow_maps.hpp"
#include "sim/simulation.hpp"

namespace thawslide::run {

struct RunCost {
  double steps = 0.0;
  double processor = std::numeric_limits<double>::quiet_NaN();  // time of one thread [s]
  double slowdown = 1.0;  // wall-clock over processor time of the measured steps; larger if other processes run
};

// Number of steps of a run if all are as long as the first one.
template <int Dim>
[[nodiscard]] double steps_to_end(sim::Simulation<Dim>& simulation);

// Cost of steps on one thread, timed by its clock, as other processes affect wall-clock time. Advances the simulation.
template <int Dim>
[[nodiscard]] RunCost cost_on_cpu(sim::Simulation<Dim>& simulation, double steps);
// The same on a device; processor is wall-clock time.
template <int Dim>
[[nodiscard]] RunCost cost_on_device(sim::Simulation<Dim>& simulation, double steps);

// "3 min of processor time", and whether the machine is busy.
[[nodiscard]] std::string text_of(const RunCost& cost);

// GPU that this program can use.
struct GpuFacts {
  std::string name;
  std::string unavailable_reason;  // reason why the GPU cannot be used; empty: it can
  double free = 0.0;               // memory before the run [bytes]
  double used = 0.0;               // by the run after its first steps [bytes]
  double seconds = 0.0;            // wall-clock time of the run, estimated from the first steps
};
[[nodiscard]] GpuFacts detect_gpu();

// Selects a GPU for the steps: "gpu", or "auto" if there is one. Returns its name, or nothing. Throws UserError.
template <int Dim>
std::string use_device(const std::string& device, sim::Simulation<Dim>& simulation);

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
