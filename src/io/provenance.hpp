// run.json: what made a run, with what, how fast, and what to cite.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/stopwatch.hpp"

namespace thawslide::io {

// An input of a run.
struct InputFile {
  std::string path;  // as it was found
  std::string copy;  // in the run's folder, e.g. inputs/profile.csv
  std::string sha256;
  std::uintmax_t bytes = 0;
};

struct Provenance {
  std::string version, commit, command, host, processor, started;  // started: UTC, ISO 8601
  int threads = 1;
  std::size_t particles = 0;
  std::vector<std::pair<std::string, std::int64_t>> removed;  // particles so far, by cause
  std::vector<double> origin, gravity;                        // [m], [m/s2] in grid axes
  std::vector<InputFile> inputs;
  std::string status, message;  // running, done, stopped, failed
  double simulated_time = 0.0, wall_seconds = 0.0;
  std::int64_t steps = 0;
  double particle_steps = 0.0;  // particles that were there, over the steps this process made in wall_seconds
  Stopwatch::Seconds seconds_per_stage;
  std::vector<std::pair<std::string, double>> figures;  // what the run comes to, in 3D; NaN: not known
  std::string crs;                                      // name of the reference system; empty: none is known
  double seconds_beside = 0.0;  // processor time that writing snapshots took while steps went on
};

// Version, commit, command line, host and time of start filled in.
Provenance provenance_of_this_program();

void write_provenance(const std::filesystem::path& file, const Provenance& provenance);

// Copies inputs into folder/inputs, one of each name; files above 50 MB become hard links where the file system can.
// Throws UserError for two files of one name, or what cannot be read.
std::vector<InputFile> copy_inputs(const std::filesystem::path& folder,
                                   const std::vector<std::filesystem::path>& files);

// The inputs that folder/run.json lists.
std::vector<InputFile> read_inputs(const std::filesystem::path& folder);

}  // namespace thawslide::io
