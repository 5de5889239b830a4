// Findings of `thawslide check`, as text and as JSON, and the figure of a case, plotted by thawslide-report --setup.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/available_memory.hpp"
#include "config/case.hpp"
#include "config/resolution.hpp"
#include "config/site.hpp"
#include "run/run_cost.hpp"
#include "sim/checks/body_figures.hpp"
#include "sim/memory_need.hpp"
#include "sim/simulation.hpp"
#include "sim/solver/time_step.hpp"

namespace thawslide::app {

// Substrate with separate laws, or the remaining ground with [basal].
struct SubstrateFacts {
  std::string name;       // empty: ground with the laws of [basal]
  std::string location;   // as text
  double covered = 0.0;   // part of the domain: [m2], in 2D [m]
  double fraction = 0.0;  // fraction of the domain
  std::string strength;   // laws as text
};

// Maps of a 3D run.
struct MapFacts {
  int columns = 0, rows = 0;
  double cell_x = 0.0, cell_y = 0.0;                 // [m]
  std::string reason;                                // for the size of the cells
  double bytes_at_start = 0.0, bytes_at_most = 0.0;  // in memory; maximum if the slide covered all cells
};

struct SetupFacts {
  std::string file;
  int dimension = 2;
  std::optional<double> width_varies_from;  // x of the first width, to which per-metre values of a section refer [m]
  std::vector<std::string> warnings;
  std::vector<sim::BodyFigures> bodies;
  std::vector<SubstrateFacts> substrates;
  std::optional<double> bed_volume;            // of the erodible bed [m3], per metre of width in 2D
  std::optional<config::Roughness> roughness;  // of a DEM
  std::size_t particles = 0;
  double cells = 0.0;                                   // in the domain
  double cells_across = 0.0;                            // across the thinnest body on terrain in 3D; 0: none
  const config::ResolutionFacts* resolution = nullptr;  // with that number; null: errors are unknown
  std::size_t blocks = 0, nodes_of_block = 0;           // allocated at the start
  double step = 0.0;                                    // [s]
  bool is_adaptive = false;
  sim::StepLimit limit;
  double steps = 0.0;
  sim::MemoryNeed memory;
  AvailableMemory available;
  std::vector<MapFacts> maps;  // one in 3D, none in 2D
  run::DiskNeed disk;
  double free_disk = 0.0;   // [bytes]
  std::string disk_folder;  // folder of the run
  run::RunCost cost;
  int threads = 1;
  run::GpuFacts gpu;
  std::string error;    // of the first steps; empty if there is none
  std::string picture;  // file of the figure; empty: none
};

[[nodiscard]] std::string text_of(const SetupFacts& facts);
[[nodiscard]] std::string json_of(const SetupFacts& facts);

// Each substrate, and last the remaining ground with [basal]; empty if the case has no substrates.
[[nodiscard]] std::vector<SubstrateFacts> substrate_facts(const config::Case& parameters, const config::Site& site);

// setup.png, prefixed by the name of a variant, because several case files may share a folder.
[[nodiscard]] std::string picture_path(const std::filesystem::path& case_file);

// setup: from setup_json. Throws UserError if thawslide-report is not found, or fails.
void draw_setup(const nlohmann::ordered_json& setup, const std::string& picture);

// A map if the terrain is a DEM, thinned to the resolution of a figure, otherwise a section along x.
template <int Dim>
nlohmann::ordered_json setup_json(const sim::Simulation<Dim>& simulation);

}  // namespace thawslide::app
