// thawslide run and resume.
#include <set>
#include <string_view>
#include <vector>

#include "app/commands.hpp"
#include "app/terminal.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "config/case_changes.hpp"
#include "config/coarse_case.hpp"
#include "config/read_case.hpp"
#include "run/run_loop.hpp"
#include "run/start.hpp"

namespace thawslide::app {

namespace {

// All changes to the case, including --end.
std::vector<std::string> with_end(std::vector<std::string> sets, const std::string& end) {
  if (!end.empty()) {
    if (config::keys_of(sets).count("time.end") > 0) {
      throw UserError("--end is short for --set time.end: give one of the two.");
    }
    sets.push_back("time.end=" + end);
  }
  return sets;
}

// Name of the folder of a trial, which does not replace the results of the case.
std::string output_of(const RunOptions& options, const config::Case& parameters) {
  return options.of_case.coarse && options.output.empty() ? run::usual_run_folder(parameters).string() + "-coarse"
                                                          : options.output;
}

// The same options for the Python program that runs the case on several cells.
std::vector<std::string> arguments_of_pair(const RunOptions& options) {
  std::vector<std::string> words{options.of_case.file, "--device", options.device};
  for (const std::string& each : options.of_case.sets) {
    words.insert(words.end(), {"--set", each});
  }
  if (options.threads > 0) {
    words.insert(words.end(), {"--threads", std::to_string(options.threads)});
  }
  if (!options.end.empty()) {
    words.insert(words.end(), {"--end", options.end});
  }
  if (!options.output.empty()) {
    words.insert(words.end(), {"--output", options.output});
  }
  if (options.overwrite) {
    words.emplace_back("--overwrite");
  }
  return words;
}

}  // namespace

config::Case case_of(const CaseOptions& options) {
  const config::Case parameters = config::read_case(options.file, options.sets);
  if (!options.coarse) {
    return parameters;
  }
  // A key of --set has its value, but for the cell, of which all others follow.
  std::vector<std::string> sets = options.sets;
  const std::set<std::string> given = config::keys_of(sets);
  if (given.count("grid.cell") > 0) {
    throw UserError("--coarse sets grid.cell: omit --coarse, or --set grid.cell.");
  }
  std::vector<std::string> added = config::coarse_changes(parameters);
  std::erase_if(added, [&](const std::string& change) { return given.count(*config::keys_of({change}).begin()) > 0; });
  sets.insert(sets.end(), added.begin(), added.end());
  try {
    config::Case trial = config::read_case(options.file, sets);
    for (const std::string& key : config::keys_of(added)) {
      trial.locations[key] = "--coarse";
    }
    return trial;
  } catch (const UserError& error) {
    std::string text = error.what();
    for (const std::string& change : added) {
      if (const std::size_t found = text.find("--set " + change); found != std::string::npos) {
        text.erase(found, std::string_view("--set ").size());
      }
    }
    throw UserError("--coarse, which sets cells of {:g} m: {}", config::trial_factor * parameters.grid.cell, text);
  }
}

int run_case(const RunOptions& options) {
  if (options.pair && options.of_case.coarse) {
    throw UserError("--pair runs the case on coarse cells, too: omit --coarse.");
  }
  if (options.pair) {
    return run_python_command("pair", arguments_of_pair(options));
  }
  survive_closed_pipes();
  use_threads(options.threads);
  Terminal terminal;
  CaseOptions of_case = options.of_case;
  of_case.sets = with_end(of_case.sets, options.end);
  const config::Case parameters = case_of(of_case);
  return static_cast<int>(
      run::start_run(parameters, {output_of(options, parameters), options.overwrite, options.device}, terminal));
}

int resume_run(const ResumeOptions& options) {
  survive_closed_pipes();
  use_threads(options.threads);
  Terminal terminal;
  return static_cast<int>(
      run::resume_run({options.folder, with_end(options.sets, options.end), options.device}, terminal));
}

}  // namespace thawslide::app
