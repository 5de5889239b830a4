// What `thawslide check` finds out of a case, and how it tells it: as text and as JSON, the same of both.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "app/device_choice.hpp"
#include "app/disk_need.hpp"
#include "app/substrate_list.hpp"
#include "base/available_memory.hpp"
#include "config/site.hpp"
#include "sim/body_figures.hpp"
#include "sim/memory_need.hpp"
#include "sim/time_step.hpp"

namespace thawslide::app {

// Of the maps of a run in space.
struct MapFacts {
  int columns = 0, rows = 0;
  double cell_x = 0.0, cell_y = 0.0;                 // [m]
  std::string reason;                                // why they are as large as they are
  double bytes_at_start = 0.0, bytes_at_most = 0.0;  // in memory, if the slide passed all of them
};

struct SetupFacts {
  std::string file;
  int dimension = 2;
  std::optional<double> width_varies_from;  // x of the first width, which figures of a section are per metre of [m]
  std::vector<std::string> warnings;
  std::vector<sim::BodyFigures> bodies;
  std::vector<SubstrateFacts> substrates;
  std::optional<config::Roughness> roughness;  // of a DEM
  std::size_t particles = 0;
  double cells = 0.0;                          // in the domain
  std::size_t blocks = 0, nodes_of_block = 0;  // held at the start
  double step = 0.0;                           // [s]
  bool is_adaptive = false;
  sim::StepLimit limit;
  double steps = 0.0;
  sim::MemoryNeed memory;
  AvailableMemory available;
  std::vector<MapFacts> maps;  // one in space, none in the plane
  DiskNeed disk;
  double free_disk = 0.0;                                     // [bytes]
  std::string disk_folder;                                    // where the run would go
  double seconds = std::numeric_limits<double>::quiet_NaN();  // of wall time, from the first steps
  int threads = 1;
  GpuFacts gpu;
  std::string error;    // what the first steps ended with; empty: nothing
  std::string picture;  // its file; empty: none
};

[[nodiscard]] std::string text_of(const SetupFacts& facts);
[[nodiscard]] std::string json_of(const SetupFacts& facts);

}  // namespace thawslide::app
