// Runs of a case in a folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "config/case.hpp"
#include "run/observer.hpp"

namespace thawslide::run {

struct StartOptions {
  std::filesystem::path folder;  // of the results; empty: runs/NAME
  bool overwrite = false;        // replace the run in the folder
  std::string device = "cpu";    // cpu, gpu or auto
};

// Runs a case with the present number of threads. Throws UserError before any file is written, and RunError.
ExitCode start_run(const config::Case& parameters, const StartOptions& options, Observer& observer);

struct ResumeOptions {
  std::filesystem::path folder;
  std::vector<std::string> sets;  // changes to the case, KEY=VALUE
  std::string device = "cpu";
};

// Continues a run from its checkpoint to its end. Throws as start_run.
ExitCode resume_run(const ResumeOptions& options, Observer& observer);

}  // namespace thawslide::run
