// thawslide resume.
#include <algorithm>
#include <memory>
#include <set>

#include "app/commands.hpp"
#include "app/device_choice.hpp"
#include "app/map_files.hpp"
#include "app/print.hpp"
#include "app/resume_checks.hpp"
#include "app/run_loop.hpp"
#include "app/signals.hpp"
#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/shell_quote.hpp"
#include "base/state_numbers.hpp"
#include "config/case_changes.hpp"
#include "config/describe.hpp"
#include "config/notices.hpp"
#include "config/read_case.hpp"
#include "io/checkpoint.hpp"
#include "io/files.hpp"
#include "io/history_writer.hpp"
#include "io/run_folder.hpp"
#include "io/run_lock.hpp"
#include "io/sha256.hpp"

namespace thawslide::app {

namespace fs = std::filesystem;

namespace {

// All changes to the case, including --end.
std::vector<std::string> sets_of(const ResumeOptions& options) {
  std::vector<std::string> sets = options.sets;
  if (!options.end.empty()) {
    if (config::keys_of(sets).count("time.end") > 0) {
      throw UserError("--end is short for --set time.end: give one of the two.");
    }
    sets.push_back("time.end=" + options.end);
  }
  return sets;
}

// Leaves a finished run unchanged, also in a read-only folder.
int leave_finished(const fs::path& folder, const io::Provenance& facts) {
  const fs::path file = folder / "case.toml";
  const bool is_known = io::has_checkpoint(folder);
  if (fs::exists(file) && io::sha256_of_file(file) != facts.parts.back().case_sha256) {
    const std::vector<std::string> changes =
        is_known ? config::differences(io::read_file(file), io::case_of(io::newest_checkpoint(folder)))
                 : std::vector<std::string>{"its SHA-256 is not that of run.json"};
    if (!changes.empty()) {
      throw UserError(fmt::format("{} has reached its end at {:g} s, and {} has changed since: {}. {}", folder.string(),
                                  facts.simulated_time, file.string(), fmt::join(changes, "; "),
                                  is_known ? advice_on(folder, facts, changes, "Put that back, or run the case again.")
                                           : "There is no checkpoint to continue from: run the case again."));
    }
  }
  print_text("{} has reached its end at {:g} s{}; nothing to do\n", folder.string(), facts.simulated_time,
             facts.message.empty() ? "" : ": " + facts.message);
  if (!is_known) {
    print_text("note: {} has no checkpoint, so --end cannot extend it\n", folder.string());
  }
  return static_cast<int>(ExitCode::done);
}

// State and case with which a run continues.
struct Continuation {
  config::Case parameters;
  std::string case_text;       // for case.toml
  io::Provenance earlier;      // contents of run.json, with the part that begins
  double earlier_end = 0.0;    // time.end before the change [s]
  std::string device = "cpu";  // --device
};

Continuation continuation_of(const fs::path& folder, const std::vector<std::string>& sets, io::Provenance facts) {
  config::require_changeable(sets);
  Continuation next{{}, io::read_file(folder / "case.toml"), std::move(facts)};
  try {
    next.parameters = config::read_case(folder, sets);
  } catch (const UserError& error) {
    report_changed_copy(folder, next.earlier.inputs, error.what());
    throw;
  }
  next.earlier_end = next.parameters.time.end;
  if (!sets.empty()) {
    const config::Case before = config::read_case(folder);
    if (config::guards_remove(before) != config::guards_remove(next.parameters)) {
      throw UserError(
          "history.csv has a column removed_mass_kg where [guards] may remove particles, and none where they may not: "
          "a continued run cannot change this. Run the case again.");
    }
    next.earlier_end = before.time.end;
    next.case_text = config::resolved_toml(next.parameters, "inputs");
  }
  io::RunPart part = io::part_of_this_process();
  part.changes = sets;
  part.case_sha256 = sha256_of_text(next.case_text);
  next.earlier.parts.push_back(std::move(part));
  return next;
}

// run.json must record a change first, so that no change is unrecorded if the process is killed in between.
void apply_changes(const fs::path& folder, const Continuation& next) {
  if (const std::vector<std::string>& changes = next.earlier.parts.back().changes; !changes.empty()) {
    write_file_atomically(folder / "case.toml", next.case_text);
    print_text("changed: {}\n", fmt::join(changes, ", "));
  }
}

template <int Dim>
void restore(sim::Simulation<Dim>& simulation, const std::vector<double>& scalars, const NamedNumbers& blocks) {
  simulation.restore(scalars);
  if (simulation.band_columns() != nullptr) {
    simulation.restore_band_columns(block_of(blocks, "band_columns"));
  }
  if (simulation.bed() != nullptr) {
    simulation.restore_bed(block_of(blocks, "bed"));
  }
}

// Reports an error that a change causes in an unchanged key at its location in the run's case.toml, which is not for
// editing.
template <int Dim>
std::unique_ptr<sim::Simulation<Dim>> simulation_of(const fs::path& folder, const Continuation& next,
                                                    Warnings& warnings) {
  try {
    return std::make_unique<sim::Simulation<Dim>>(next.parameters, read_map_files(next.parameters, warnings));
  } catch (const UserError& error) {
    if (std::string(error.what()).rfind((folder / "case.toml").string(), 0) != 0) {
      throw;
    }
    throw UserError(
        fmt::format("{} Specify changes of a run on the command line: thawslide resume {} --set "
                    "KEY=VALUE.",
                    error.what(), shell_quote(folder.string())));
  }
}

template <int Dim>
int restart_from_begin(const fs::path& folder, const Continuation& next) {
  Warnings warnings;
  sim::Simulation<Dim> simulation(next.parameters, read_map_files(next.parameters, warnings));
  use_device<Dim>(next.device, simulation);
  print_text("{} was cut off before its first checkpoint; it starts again\n", folder.string());
  for (const std::string& warning : next.earlier.parts.back().warnings) {
    print_text("warning: {}\n", warning);
  }
  RunOutput<Dim> output(folder, simulation, next.earlier, next.case_text);
  apply_changes(folder, next);
  warnings.add(config::notices(next.parameters));
  return start_and_run<Dim>(simulation, output, folder);
}

// True if a finished run continues with the changes. falls_back: its last checkpoint is lost. Throws UserError if the
// run cannot continue and the changes would be lost.
template <int Dim>
bool takes_changes_at_its_end(const fs::path& folder, const Continuation& next, bool falls_back,
                              sim::Simulation<Dim>& simulation) {
  const std::vector<std::string>& changes = next.earlier.parts.back().changes;
  const bool is_end_alone = config::keys_of(changes) == std::set<std::string>{"time.end"};
  if (simulation.time() >= next.parameters.time.end - 0.5 * simulation.last_step()) {
    if (!changes.empty() && !is_end_alone) {
      throw UserError(fmt::format(
          "{} has reached its end at {:g} s: no step is left that could take {}. Give a later end too: --end T.",
          folder.string(), simulation.time(), fmt::join(changes, ", ")));
    }
    print_text("{} has reached its end at {:g} s; nothing to do\n", folder.string(), simulation.time());
    return false;
  }
  if (simulation.ends_at_rest()) {
    if (changes.empty() || is_end_alone) {
      print_text("{} has come to rest at {:g} s; nothing to do. To continue it, add --set time.stop_at_rest=0\n",
                 folder.string(), simulation.time());
      return false;
    }
    simulation.restart_rest_time();
  } else if (next.earlier.message.rfind(sim::at_rest, 0) != 0 &&
             simulation.time() < next.earlier_end - 0.5 * simulation.last_step() && !falls_back &&
             !next.earlier.message.empty()) {
    throw UserError(
        fmt::format("{} has ended, and no particles are left to continue with: {}. Run the case again, "
                    "in a larger domain.",
                    folder.string(), next.earlier.message));
  }
  return true;
}

// Renames a damaged checkpoint, because the next one would otherwise replace the valid one and keep the damaged one.
// Returns a text with the new name.
std::string keep_damaged(const fs::path& damaged) {
  if (damaged.empty()) {
    return "";
  }
  const fs::path aside = io::name_for_damaged(damaged);
  std::error_code error;
  fs::rename(damaged, aside, error);
  if (error) {
    throw WriteError(
        fmt::format("{} cannot be renamed to {}: {}. Make the run's folder one that can be written, then resume "
                    "again.",
                    damaged.string(), aside.filename().string(), error.message()));
  }
  return fmt::format("it is kept as {}, and ", aside.filename().string());
}

template <int Dim>
int continue_run(const fs::path& folder, const io::WholeCheckpoint& checkpoint, Continuation next) {
  Warnings warnings;
  const auto made = simulation_of<Dim>(folder, next, warnings);
  sim::Simulation<Dim>& simulation = *made;
  std::vector<double> scalars;
  const NamedNumbers blocks = io::read_checkpoint<Dim>(checkpoint, simulation.particles(), scalars);
  try {
    restore<Dim>(simulation, scalars, blocks);
  } catch (const UserError& error) {
    throw UserError(fmt::format("{}: {}", checkpoint.file.string(), error.what()));
  }
  use_device<Dim>(next.device, simulation);
  const double end = next.parameters.time.end, half_a_step = 0.5 * simulation.last_step();
  const double had_come_to = std::max(next.earlier.simulated_time,
                                      io::last_time_in_history(folder / "history.csv").value_or(simulation.time()));
  // A failed run is simulated again from its checkpoint, and may end before the time of failure.
  const bool failed = next.earlier.status == "failed";
  const double has_come_to = failed ? simulation.time() : had_come_to;
  if (end < next.earlier_end && end < has_come_to - half_a_step) {
    throw UserError(
        fmt::format("the end of {:g} s has passed: the run had reached {:g} s. Give a later one.", end, has_come_to));
  }
  if (failed && next.earlier.parts.back().changes.empty()) {
    print_text(
        "warning: the run failed, and resume changes nothing: it will probably fail again. Change a key with --set "
        "KEY=VALUE, or end before the failure with --end T\n");
  }
  if (next.earlier.status == "done" &&
      !takes_changes_at_its_end<Dim>(folder, next, !checkpoint.warning.empty(), simulation)) {
    return static_cast<int>(ExitCode::done);
  }
  if (!checkpoint.warning.empty()) {
    next.earlier.parts.back().warnings.push_back(fmt::format("{}; {}the run continues from the previous checkpoint",
                                                             checkpoint.warning, keep_damaged(checkpoint.damaged)));
  }
  RunOutput<Dim> output = RunOutput<Dim>::resume(folder, simulation, blocks, next.earlier, next.case_text);
  print_text("continuing from t = {:g} s{}\n", simulation.time(),
             had_come_to > simulation.time()
                 ? fmt::format("; it had reached {:g} s: rows and snapshots after {:g} s are written again",
                               had_come_to, simulation.time())
                 : "");
  apply_changes(folder, next);
  warnings.add(config::notices(next.parameters));
  return run_to_end<Dim>(simulation, output, folder);
}

}  // namespace

int resume_run(const ResumeOptions& options) {
  survive_closed_pipes();
  use_threads(options.threads);
  const fs::path folder = options.folder;
  if (!fs::exists(folder / "run.json")) {
    throw UserError(
        fmt::format("{} is not a run folder: run.json not found. Specify the folder that `thawslide run` "
                    "printed, or run the case again.",
                    folder.string()));
  }
  const std::vector<std::string> sets = sets_of(options);
  if (sets.empty() && io::process_at_work(folder).process.empty()) {
    const io::Provenance facts = io::read_provenance(folder);
    if (facts.status == "done") {
      return leave_finished(folder, facts);
    }
  }
  const io::RunLock lock(folder);
  io::require_own_folders(folder, {"snapshots", "inputs"});
  const io::Provenance facts = io::read_provenance(folder);
  io::WholeCheckpoint checkpoint;
  const bool has_checkpoint = io::has_checkpoint(folder);
  if (has_checkpoint) {
    checkpoint = io::newest_checkpoint(folder);
    require_same_case(folder, facts, io::case_of(checkpoint), sets);
  } else {
    require_no_more_than_a_start(folder, facts);
    require_case_of_start(folder, facts, sets);
  }
  for (const char* place : {".", "inputs", "snapshots", "maps"}) {
    io::remove_unfinished_files(folder / place);
  }
  Continuation next = continuation_of(folder, sets, facts);
  next.device = options.device;
  if (next.parameters.general.dimension == 3) {
    io::require_own_folders(folder, {"maps"});
  }
  require_same_inputs(folder, facts.inputs, next.parameters.report);
  next.earlier.parts.back().warnings = changed_originals(facts.inputs);
  return with_dimension(
      next.parameters.general.dimension, [&]<int Dim>(std::integral_constant<int, Dim> /*dimension*/) {
        return has_checkpoint ? continue_run<Dim>(folder, checkpoint, next) : restart_from_begin<Dim>(folder, next);
      });
}

}  // namespace thawslide::app
