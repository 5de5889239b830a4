// thawslide run and resume.
#include "app/commands.hpp"
#include "app/process.hpp"
#include "app/terminal.hpp"
#include "base/error.hpp"
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

}  // namespace

int run_case(const RunOptions& options) {
  survive_closed_pipes();
  run::use_threads(options.threads);
  Terminal terminal;
  const config::Case parameters = config::read_case(options.of_case.file, with_end(options.of_case.sets, options.end));
  return static_cast<int>(run::start_run(parameters, {options.output, options.overwrite, options.device}, terminal));
}

int resume_run(const ResumeOptions& options) {
  survive_closed_pipes();
  run::use_threads(options.threads);
  Terminal terminal;
  return static_cast<int>(
      run::resume_run({options.folder, with_end(options.sets, options.end), options.device, options.output}, terminal));
}

}  // namespace thawslide::app
