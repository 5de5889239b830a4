// run.json: what made a run, with what, in which parts, how fast, and what to cite.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
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

// What one process did of a run: the first, or one that went on from a checkpoint.
struct RunPart {
  std::string version, commit, command, host, processor, started;  // started: UTC, ISO 8601
  int threads = 1;
  std::string device;                 // that took the steps; empty: the processor
  double from_time = 0.0;             // simulated time it began at [s]
  std::vector<std::string> changes;   // of the case, as --set texts
  std::vector<std::string> warnings;  // of what it found damaged when it began, and did about it
  std::string case_sha256;            // of the resolved case that it ran
  double wall_seconds = 0.0;
  double particle_steps = 0.0;  // particles that were there, summed over its steps
};

struct Provenance {
  std::vector<RunPart> parts;  // one at least
  std::size_t particles = 0;
  std::vector<std::pair<std::string, std::int64_t>> removed;  // particles so far, by cause
  std::vector<double> origin, gravity;                        // [m], [m/s2] in grid axes
  std::vector<InputFile> inputs;
  std::string status, message;  // running, done, stopped, failed
  double simulated_time = 0.0;
  std::int64_t steps = 0;
  Stopwatch::Seconds seconds_per_stage;                   // of the last part
  std::optional<bool> at_rest;                            // of the slide; nothing: not known
  std::vector<std::string> warnings;                      // about the results
  std::vector<std::pair<std::string, double>> figures;    // results in numbers; NaN: not known
  std::vector<std::pair<std::string, double>> roughness;  // of a DEM, and the filter; empty: there is none
  std::string crs;                                        // name of the reference system; empty: none is known
  double writer_seconds = 0.0;  // processor time that writing snapshots took while steps went on, in the last part
};

// Version, commit, command line, host and time of start filled in.
RunPart part_of_this_process();

void write_provenance(const std::filesystem::path& file, const Provenance& provenance);

// Copies inputs into folder/inputs, one of each name. Throws UserError for what cannot be read, and for a file that is
// called as the program's own unfinished ones, which a resume would remove.
std::vector<InputFile> copy_inputs(const std::filesystem::path& folder,
                                   const std::vector<std::filesystem::path>& files);

// What folder/run.json tells of the run so far: parts, inputs, status, message (control letters in these two as '?'),
// simulated time and steps; the rest is left empty. Throws UserError where it cannot be read or understood.
Provenance read_provenance(const std::filesystem::path& folder);

// SHA-256 of a file, in hexadecimal digits. Throws UserError if it cannot be read.
std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace thawslide::io
