// Checks of a run's folder before `thawslide resume` continues it. All functions throw UserError on failure.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/case.hpp"
#include "io/provenance.hpp"
#include "run/observer.hpp"

namespace thawslide::run {

// Requires unchanged copies of the inputs, without added files. Those of [report] may change, as only figures use them.
void require_same_inputs(const std::filesystem::path& folder, const std::vector<io::InputFile>& inputs,
                         const config::Case& now);

// Notes on original input files that have changed. A run continues with its copies regardless.
[[nodiscard]] std::vector<std::string> changed_originals(const std::vector<io::InputFile>& inputs);

// Called on an error of reading the case: if the file is a changed copy, reports that change instead.
void report_changed_copy(const std::filesystem::path& folder, const std::vector<io::InputFile>& inputs,
                         const std::string& error);

// Requires that case.toml is that of the checkpoint (`before`) or of a later resume, except for keys in `sets`, which
// must include the changes by interrupted resumes.
void require_same_case(const std::filesystem::path& folder, const io::Provenance& facts, const std::string& before,
                       const std::vector<std::string>& sets, Observer& observer);

// The same before the first checkpoint, when the case is known only by its SHA-256.
void require_case_of_start(const std::filesystem::path& folder, const io::Provenance& facts,
                           const std::vector<std::string>& sets);

// Requires that a changed case of a run removes particles by [guards] as before.
void require_same_guards(const config::Case& before, const config::Case& now);

// Requires an end [s] that is not before the time that the run has reached, up to half of a step.
void require_end_ahead(double end, double reached, double step);

// A run without checkpoints starts again, which is allowed only if it was interrupted before the first.
void require_no_more_than_a_start(const std::filesystem::path& folder, const io::Provenance& facts);

}  // namespace thawslide::run
