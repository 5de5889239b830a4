// run.json: origin, inputs, parts and performance of a run, and citations.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/clocks.hpp"

namespace thawslide::io {

// Input file of a run.
struct InputFile {
  std::string path;  // original path
  std::string copy;  // in the run folder, e.g. inputs/profile.csv
  std::string sha256;
  std::uintmax_t bytes = 0;
};

// Part of a run by one process: the first, or one that resumed from a checkpoint.
struct RunPart {
  std::string version, commit, command, host, processor, started;  // started: UTC, ISO 8601
  int threads = 1;
  std::string device = {};                 // device of the steps; empty: CPU
  double from_time = 0.0;                  // simulated time at the beginning [s]
  std::vector<std::string> changes = {};   // to the case, as --set texts
  std::vector<std::string> warnings = {};  // about damaged files at the beginning, and their treatment
  std::string case_sha256 = {};            // of the resolved case of this part
  double wall_seconds = 0.0;
  double particle_steps = 0.0;  // number of particles, summed over the steps
};

struct Provenance {
  std::vector<RunPart> parts;  // at least one
  std::size_t particles = 0;
  std::vector<std::pair<std::string, std::int64_t>> removed;  // number of removed particles so far, by cause
  std::vector<double> origin, gravity;                        // [m], [m/s2] in grid axes
  std::vector<InputFile> inputs;
  std::string status, message;  // running, done, stopped, failed
  double simulated_time = 0.0;
  std::int64_t steps = 0;
  Stopwatch::Seconds seconds_per_stage;                   // of the last part
  std::optional<bool> at_rest;                            // empty: unknown
  std::vector<std::string> warnings;                      // about the results
  std::vector<std::pair<std::string, double>> figures;    // numerical results; NaN: unknown
  std::vector<std::pair<std::string, double>> roughness;  // of a DEM, and the filter; empty without a DEM
  std::string crs;                                        // name of the reference system; empty: unknown
  double writer_seconds = 0.0;  // CPU time of writing snapshots in parallel with steps, in the last part
};

// Part with version, commit, command line, host and start time of this process.
RunPart part_of_this_process();

void write_provenance(const std::filesystem::path& file, const Provenance& provenance);

// Copies inputs into folder/inputs; `texts`: of files read before. Throws UserError for an unreadable file or a name of
// the program's own temporary files.
std::vector<InputFile> copy_inputs(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& files,
                                   const std::map<std::filesystem::path, std::string>& texts = {});

// Reads parts, inputs, status, message, time and steps from folder/run.json. Throws UserError if it is invalid.
Provenance read_provenance(const std::filesystem::path& folder);

// SHA-256 of a file, in hexadecimal digits. Throws UserError if it cannot be read.
std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace thawslide::io
