// thawslide run and resume.
#include <csignal>
#include <vector>

#include "app/commands.hpp"
#include "app/terminal.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "config/case_changes.hpp"
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

int run_case(const RunOptions& options) {
  if (options.pair) {
    return run_python_command("pair", arguments_of_pair(options));
  }
  std::signal(SIGPIPE, SIG_IGN);  // the run continues without a reader of its lines
  use_threads(options.threads);
  Terminal terminal;
  const config::Case parameters = config::read_case(options.of_case.file, with_end(options.of_case.sets, options.end));
  return static_cast<int>(run::start_run(parameters, {options.output, options.overwrite, options.device}, terminal));
}

int resume_run(const ResumeOptions& options) {
  std::signal(SIGPIPE, SIG_IGN);  // the run continues without a reader of its lines
  use_threads(options.threads);
  Terminal terminal;
  return static_cast<int>(
      run::resume_run({options.folder, with_end(options.sets, options.end), options.device}, terminal));
}

}  // namespace thawslide::app
