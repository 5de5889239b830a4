#include "run/start.hpp"

#include <algorithm>
#include <memory>
#include <set>

#include "base/atomic_file.hpp"
#include "base/parallel.hpp"
#include "base/rounding.hpp"
#include "base/state_numbers.hpp"
#include "base/text.hpp"
#include "config/case_changes.hpp"
#include "config/describe.hpp"
#include "config/input_limits.hpp"
#include "config/notices.hpp"
#include "config/read_case.hpp"
#include "io/checkpoint.hpp"
#include "io/files.hpp"
#include "io/history_writer.hpp"
#include "io/run_folder.hpp"
#include "io/run_lock.hpp"
#include "run/input_files.hpp"
#include "run/resume_checks.hpp"
#include "run/run_cost.hpp"
#include "run/run_loop.hpp"
#include "run/run_output.hpp"
#include "run/setup.hpp"

namespace thawslide::run {

namespace fs = std::filesystem;

namespace {

// Leaves a finished run unchanged, also in a read-only folder.
ExitCode leave_finished(const fs::path& folder, const io::Provenance& facts, Observer& observer) {
  const fs::path file = folder / "case.toml";
  const bool is_known = io::has_checkpoint(folder);
  if (fs::exists(file) && io::sha256_of_file(file) != facts.parts.back().case_sha256) {
    const std::vector<std::string> changes =
        is_known ? config::differences(io::read_file(file), io::case_of(io::newest_checkpoint(folder)))
                 : std::vector<std::string>{"its SHA-256 is not that of run.json"};
    if (!changes.empty()) {
      throw UserError("{} has reached its end at {:g} s, and {} has changed since: {}. {}", folder.string(),
                      facts.simulated_time, file.string(), fmt::join(changes, "; "),
                      is_known ? fmt::format("Put that back, or specify changes on the command line: thawslide resume "
                                             "{} --set KEY=VALUE --end T.",
                                             shell_quote(folder.string()))
                               : "There is no checkpoint to continue from: run the case again.");
    }
  }
  observer.line("{} has reached its end at {:g} s{}; nothing to do", folder.string(), facts.simulated_time,
                facts.message.empty() ? "" : ": " + facts.message);
  if (!is_known) {
    observer.line("note: {} has no checkpoint, so --end cannot extend it", folder.string());
  }
  return ExitCode::done;
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
  Continuation next{{}, io::read_file(folder / "case.toml"), std::move(facts)};
  try {
    next.parameters = config::read_case(folder, sets);
  } catch (const UserError& error) {
    report_changed_copy(folder, next.earlier.inputs, error.what());
    throw;
  }
  config::require_changeable(sets);
  next.earlier_end = next.parameters.time.end;
  if (!sets.empty()) {
    const config::Case before = config::read_case(folder);
    require_same_guards(before, next.parameters);
    next.earlier_end = before.time.end;
    next.case_text = config::resolved_toml(next.parameters, "inputs");
  }
  io::RunPart part = io::part_of_this_process();
  part.changes = sets;
  part.case_sha256 = io::sha256_hex(next.case_text);
  next.earlier.parts.push_back(std::move(part));
  return next;
}

// run.json must record a change first, so that no change is unrecorded if the process is killed in between.
void apply_changes(const fs::path& folder, const Continuation& next, Observer& observer) {
  if (const std::vector<std::string>& changes = next.earlier.parts.back().changes; !changes.empty()) {
    write_file_atomically(folder / "case.toml", next.case_text);
    observer.line("changed: {}", fmt::join(changes, ", "));
  }
}

// Reports an error that a change causes in an unchanged key of the run's case.toml, which is not for editing.
template <int Dim>
std::unique_ptr<sim::Simulation<Dim>> simulation_of(const fs::path& folder, const Continuation& next,
                                                    Warnings& warnings) {
  try {
    return std::make_unique<sim::Simulation<Dim>>(next.parameters, read_map_files(next.parameters, warnings));
  } catch (const UserError& error) {
    if (std::string(error.what()).rfind((folder / "case.toml").string(), 0) != 0) {
      throw;
    }
    throw UserError("{} Specify changes of a run on the command line: thawslide resume {} --set KEY=VALUE.",
                    error.what(), shell_quote(folder.string()));
  }
}

template <int Dim>
ExitCode restart_from_begin(const fs::path& folder, const Continuation& next, Observer& observer) {
  Warnings warnings(&observer);
  sim::Simulation<Dim> simulation(next.parameters, read_map_files(next.parameters, warnings));
  use_device<Dim>(next.device, simulation);
  observer.line("{} was cut off before its first checkpoint; it starts again", folder.string());
  observer.texts("warning: ", next.earlier.parts.back().warnings);
  RunOutput<Dim> output(folder, simulation, next.earlier, next.case_text);
  apply_changes(folder, next, observer);
  warnings.add(config::notices(next.parameters));
  return start_and_run<Dim>(simulation, output, folder, observer);
}

// True if a finished run continues with the changes; falls_back: its last checkpoint is lost. Throws UserError.
template <int Dim>
bool applies_changes_at_its_end(const fs::path& folder, const Continuation& next, bool falls_back,
                                sim::Simulation<Dim>& simulation, Observer& observer) {
  const std::vector<std::string>& changes = next.earlier.parts.back().changes;
  const bool is_end_alone = config::keys_of(changes) == std::set<std::string>{"time.end"};
  if (has_reached_end(simulation.time(), simulation.last_step(), next.parameters.time.end)) {
    if (!changes.empty() && !is_end_alone) {
      throw UserError(
          "{} has reached its end at {:g} s: no step is left that could take {}. Give a later end too: --end T.",
          folder.string(), simulation.time(), fmt::join(changes, ", "));
    }
    observer.line("{} has reached its end at {:g} s; nothing to do", folder.string(), simulation.time());
    return false;
  }
  if (simulation.ends_at_rest()) {
    if (changes.empty() || is_end_alone) {
      observer.line("{} has {} {:g} s; nothing to do. To continue it, add --set time.stop_at_rest=0", folder.string(),
                    simulation.moved_mass().has_moved ? "come to rest at" : "not moved until", simulation.time());
      return false;
    }
    simulation.restart_rest_time();
  } else if (next.earlier.message.rfind(sim::at_rest, 0) != 0 && next.earlier.message.rfind(sim::not_moved, 0) != 0 &&
             !has_reached_end(simulation.time(), simulation.last_step(), next.earlier_end) && !falls_back &&
             !next.earlier.message.empty()) {
    throw UserError(
        "{} has ended, and no particles are left to continue with: {}. Run the case again, in a larger domain.",
        folder.string(), next.earlier.message);
  }
  return true;
}

// Renames a damaged checkpoint, which would otherwise replace the valid one. Returns a text with its new name.
std::string keep_damaged(const fs::path& damaged) {
  if (damaged.empty()) {
    return "";
  }
  const fs::path aside = io::name_for_damaged(damaged);
  std::error_code error;
  fs::rename(damaged, aside, error);
  if (error) {
    throw WriteError(
        "{} cannot be renamed to {}: {}. Make the run's folder one that can be written, then resume again.",
        damaged.string(), aside.filename().string(), error.message());
  }
  return fmt::format("it is kept as {}, and ", aside.filename().string());
}

template <int Dim>
ExitCode continue_run(const fs::path& folder, const io::WholeCheckpoint& checkpoint, Continuation next,
                      Observer& observer) {
  Warnings warnings(&observer);
  const auto made = simulation_of<Dim>(folder, next, warnings);
  sim::Simulation<Dim>& simulation = *made;
  std::vector<double> scalars;
  const NamedNumbers blocks = io::read_checkpoint<Dim>(checkpoint, simulation.particles(), scalars);
  try {
    restore_state<Dim>(simulation, scalars, blocks);
  } catch (const UserError& error) {
    throw UserError("{}: {}", checkpoint.file.string(), error.what());
  }
  use_device<Dim>(next.device, simulation);
  const double end = next.parameters.time.end;
  const double reached_before = std::max(next.earlier.simulated_time,
                                         io::last_time_in_history(folder / "history.csv").value_or(simulation.time()));
  // A failed run is simulated again from its checkpoint, and may end before the time of failure.
  const bool failed = next.earlier.status == "failed";
  const double reached = failed ? simulation.time() : reached_before;
  if (end < next.earlier_end) {
    require_end_ahead(end, reached, simulation.last_step());
  }
  if (failed && next.earlier.parts.back().changes.empty()) {
    observer.line(
        "warning: the run failed, and resume changes nothing: it will probably fail again. Change a key with --set "
        "KEY=VALUE, or end before the failure with --end T");
  }
  if (next.earlier.status == "done" &&
      !applies_changes_at_its_end<Dim>(folder, next, !checkpoint.warning.empty(), simulation, observer)) {
    return ExitCode::done;
  }
  if (!checkpoint.warning.empty()) {
    next.earlier.parts.back().warnings.push_back(fmt::format("{}; {}the run continues from the previous checkpoint",
                                                             checkpoint.warning, keep_damaged(checkpoint.damaged)));
  }
  RunOutput<Dim> output = RunOutput<Dim>::resume(folder, simulation, blocks, next.earlier, next.case_text);
  observer.texts("warning: ", output.provenance().parts.back().warnings);
  observer.line("continuing from t = {:g} s{}", simulation.time(),
                reached_before > simulation.time()
                    ? fmt::format("; it had reached {:g} s: rows and snapshots after {:g} s are written again",
                                  reached_before, simulation.time())
                    : "");
  apply_changes(folder, next, observer);
  warnings.add(config::notices(next.parameters));
  return run_to_end<Dim>(simulation, output, folder, observer);
}

void require_run_folder(const fs::path& folder) {
  if (!fs::exists(folder / "run.json")) {
    throw UserError(
        "{} is not a run folder: run.json not found. Specify the folder that `thawslide run` printed, or run the case "
        "again.",
        folder.string());
  }
}

}  // namespace

ExitCode start_run(const config::Case& parameters, const StartOptions& options, Observer& observer) {
  const fs::path folder = options.folder.empty() ? usual_run_folder(parameters) : options.folder;
  require_readable_inputs(parameters);
  require_no_input_in(folder, parameters);
  io::require_usable(folder, options.overwrite);
  return with_dimension(parameters.general.dimension, [&]<int Dim>(std::integral_constant<int, Dim> /*dimension*/) {
    Warnings warnings(&observer);
    sim::Simulation<Dim> simulation = config::with_unusual_numbers(
        parameters, [&] { return sim::Simulation<Dim>(parameters, read_map_files(parameters, warnings)); });
    {
      sim::RunRecords<Dim> records(simulation, simulation.site());  // throws before any file is written or removed
      records.start(simulation);
      add_setup_warnings(simulation, sim::body_figures(simulation), warnings);
      warnings.add(warning_of_disk(parameters, disk_need(simulation, records.maps(), steps_to_end(simulation)),
                                   free_on_disk(folder), folder));
    }
    const std::string device = use_device<Dim>(options.device, simulation);
    const io::RunLock lock = io::make_run_folder(folder, options.overwrite);
    RunOutput<Dim> output(folder, simulation);
    observer.line("{}: {} particles, {:g} s to simulate, on {} thread{}{}",
                  config::shown(parameters.general.title.empty() ? parameters.name : parameters.general.title),
                  count_text(static_cast<double>(simulation.particles().size())), parameters.time.end, thread_count(),
                  thread_count() == 1 ? "" : "s", device.empty() ? "" : " and " + device);
    return start_and_run<Dim>(simulation, output, folder, observer);
  });
}

ExitCode resume_run(const ResumeOptions& options, Observer& observer) {
  const fs::path& folder = options.folder;
  const std::vector<std::string>& sets = options.sets;
  require_run_folder(folder);
  if (sets.empty() && io::process_at_work(folder).empty()) {
    const io::Provenance facts = io::read_provenance(folder);
    if (facts.status == "done") {
      return leave_finished(folder, facts, observer);
    }
  }
  const io::RunLock lock(folder);
  io::require_own_folders(folder, {"snapshots", "inputs"});
  const io::Provenance facts = io::read_provenance(folder);
  io::WholeCheckpoint checkpoint;
  const bool has_checkpoint = io::has_checkpoint(folder);
  if (has_checkpoint) {
    checkpoint = io::newest_checkpoint(folder);
    require_same_case(folder, facts, io::case_of(checkpoint), sets, observer);
  } else {
    require_no_more_than_a_start(folder, facts);
    require_case_of_start(folder, facts, sets);
  }
  for (const char* path : {".", "inputs", "snapshots", "maps"}) {
    io::remove_unfinished_files(folder / path);
  }
  Continuation next = continuation_of(folder, sets, facts);
  next.device = options.device;
  if (next.parameters.general.dimension == 3) {
    io::require_own_folders(folder, {"maps"});
  }
  require_same_inputs(folder, facts.inputs, next.parameters);
  next.earlier.parts.back().warnings = changed_originals(facts.inputs);
  return with_dimension(next.parameters.general.dimension,
                        [&]<int Dim>(std::integral_constant<int, Dim> /*dimension*/) {
                          return has_checkpoint ? continue_run<Dim>(folder, checkpoint, next, observer)
                                                : restart_from_begin<Dim>(folder, next, observer);
                        });
}

}  // namespace thawslide::run
