#include "run/resume_checks.hpp"

#include <algorithm>
#include <optional>
#include <set>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/text.hpp"
#include "config/case_changes.hpp"
#include "config/input_limits.hpp"
#include "io/files.hpp"
#include "io/history_writer.hpp"
#include "run/input_files.hpp"

namespace thawslide::run {

namespace fs = std::filesystem;

namespace {

// Changes by interrupted resumes to the case of this SHA-256: in run.json, not in case.toml. Empty for no such part.
std::optional<std::vector<std::string>> changes_cut_off(const io::Provenance& facts, const std::string& case_sha256) {
  std::vector<std::string> changes;
  for (auto part = facts.parts.rbegin(); part != facts.parts.rend(); ++part) {
    if (part->case_sha256 == case_sha256) {
      return changes;
    }
    changes.insert(changes.begin(), part->changes.begin(), part->changes.end());
  }
  return std::nullopt;
}

// Requires these changes to be specified again, because run.json lists them already. Their keys may have other values.
void require_same_changes(const fs::path& folder, const std::vector<std::string>& changes,
                          const std::vector<std::string>& sets) {
  const std::set<std::string> specified = config::keys_of(sets);
  std::vector<std::string> missing;
  for (const std::string& change : changes) {
    const std::string key = *config::keys_of({change}).begin();
    // If a key was changed more than once, the last change applies.
    missing.erase(std::remove_if(missing.begin(), missing.end(),
                                 [&](const std::string& other) { return *config::keys_of({other}).begin() == key; }),
                  missing.end());
    if (specified.count(key) == 0) {
      missing.push_back(change);
    }
  }
  if (!missing.empty()) {
    missing.insert(missing.end(), sets.begin(), sets.end());
    std::vector<std::string> words(missing.size());
    std::ranges::transform(missing, words.begin(), shell_quote);
    throw UserError(
        "the last resume was interrupted before its change took effect. Specify it again: thawslide resume {} --set {}",
        shell_quote(folder.string()), fmt::join(words, " --set "));
  }
}

// Requires that the checkpoint belongs to this run, because that of another run may have been copied there.
void require_checkpoint_of_run(const fs::path& folder, const io::Provenance& facts, const std::string& now,
                               const std::string& of_checkpoint) {
  const std::string sha256 = io::sha256_hex(of_checkpoint);
  const bool is_known =
      std::ranges::any_of(facts.parts, [&](const io::RunPart& part) { return part.case_sha256 == sha256; });
  if (!is_known) {
    const std::vector<std::string> differences = config::differences(of_checkpoint, now);
    throw UserError(
        "the checkpoint of {} was not written by this run: run.json lists no part with its case{}{}. Put back the "
        "run's own checkpoint.bin or checkpoint.previous.bin, or run the case again.",
        folder.string(), differences.empty() ? "" : ", in which ", fmt::join(differences, "; "));
  }
}

}  // namespace

void require_same_inputs(const fs::path& folder, const std::vector<io::InputFile>& inputs, const config::Case& now) {
  std::vector<std::string> changed;
  for (const io::InputFile& input : inputs) {
    const fs::path copy = folder / input.copy;
    if (fs::path(input.copy).parent_path() != "inputs") {
      throw UserError("{}: damaged: it names {} as the copy of an input; those lie in inputs/.",
                      (folder / "run.json").string(), input.copy);
    }
    const auto is_copy_of = [&copy](const fs::path& file) { return copy.filename() == file.filename(); };
    if (is_copy_of(now.report.targets) || is_copy_of(now.report.force_record)) {
      continue;
    }
    if (!fs::exists(copy)) {
      changed.push_back(copy.string() + " is missing");
    } else if (io::sha256_of_file(copy) != input.sha256) {
      changed.push_back(copy.string() + " has changed");
    }
  }
  for (const fs::path& file : input_files(now)) {
    const auto is_copy = [&file](const io::InputFile& input) {
      return fs::path(input.copy).filename() == file.filename();
    };
    if (file.parent_path().filename() == "inputs" && std::ranges::none_of(inputs, is_copy)) {
      changed.push_back(file.string() + " was added and must be removed");
    }
  }
  if (!changed.empty()) {
    throw UserError(
        "{}. A run continues with the inputs of its start (run.json has their SHA-256): put them back, or run the case "
        "again.",
        fmt::join(changed, "; "));
  }
}

std::vector<std::string> changed_originals(const std::vector<io::InputFile>& inputs) {
  std::vector<std::string> warnings;
  for (const io::InputFile& input : inputs) {
    std::error_code unreadable;
    const bool same_size = fs::file_size(input.path, unreadable) == input.bytes;
    if (!unreadable && (!same_size || io::sha256_of_file(input.path) != input.sha256)) {
      warnings.push_back(fmt::format("{} has changed since the run began. The run continues with its copy, {}",
                                     config::shown(input.path), config::shown(input.copy)));
    }
  }
  return warnings;
}

void report_changed_copy(const fs::path& folder, const std::vector<io::InputFile>& inputs, const std::string& error) {
  const config::Case names_no_files;
  for (const io::InputFile& input : inputs) {
    if (error.find(input.copy) != std::string::npos) {
      require_same_inputs(folder, {input}, names_no_files);
    }
  }
}

void require_same_case(const fs::path& folder, const io::Provenance& facts, const std::string& before,
                       const std::vector<std::string>& sets, Observer& observer) {
  const fs::path file = folder / "case.toml";
  if (!fs::exists(file)) {
    write_file_atomically(file, before);
    observer.line("note: {} was missing. It was written again from the checkpoint", file.string());
  }
  const std::string now = io::read_file(file);
  require_checkpoint_of_run(folder, facts, now, before);
  std::optional<std::vector<std::string>> cut_off = changes_cut_off(facts, io::sha256_hex(now));
  if (!cut_off) {
    const std::vector<std::string> changes = config::differences(now, before, config::keys_of(sets));
    if (!changes.empty()) {
      throw UserError(
          "{} has changed since the run wrote its checkpoint: {}. Put that back, or remove the file, which is then "
          "written again. Specify changes on the command line: thawslide resume {} --set KEY=VALUE, or --end T.",
          file.string(), fmt::join(changes, "; "), shell_quote(folder.string()));
    }
    cut_off = changes_cut_off(facts, io::sha256_hex(before));  // the case text is that of the checkpoint
  }
  require_same_changes(folder, *cut_off, sets);
}

void require_case_of_start(const fs::path& folder, const io::Provenance& facts, const std::vector<std::string>& sets) {
  const fs::path file = folder / "case.toml";
  const bool is_present = fs::exists(file);
  const auto cut_off = changes_cut_off(facts, is_present ? io::sha256_of_file(file) : "");
  if (!cut_off) {
    throw UserError("{} {}, and no checkpoint holds its content. Put back what was there, or run the case again.",
                    file.string(),
                    is_present ? "has changed since the run began (run.json has its SHA-256)" : "is missing");
  }
  require_same_changes(folder, *cut_off, sets);
}

void require_same_guards(const config::Case& before, const config::Case& now) {
  if (config::guards_remove(before) != config::guards_remove(now)) {
    throw UserError(
        "the history has a column removed_mass_kg if [guards] may remove particles, and none otherwise: a continued "
        "run cannot change this. Run the case again.");
  }
}

void require_end_ahead(double end, double reached, double step) {
  if (end < reached - 0.5 * step) {
    throw UserError("the end of {:g} s has passed: the run had reached {:g} s. Give a later one.", end, reached);
  }
}

void require_no_more_than_a_start(const fs::path& folder, const io::Provenance& facts) {
  const double reached_before =
      std::max(facts.simulated_time, io::last_time_in_history(folder / "history.csv").value_or(0.0));
  if (facts.steps > 0 || reached_before > 0.0) {
    throw UserError(
        "{0} had reached {1:g} s, but checkpoint.bin and checkpoint.previous.bin are missing. A new start would "
        "overwrite its results. Put one of them back, or run the case again in another folder: thawslide run {2} "
        "--output OTHER.",
        folder.string(), reached_before, shell_quote(folder.string()));
  }
}

}  // namespace thawslide::run
