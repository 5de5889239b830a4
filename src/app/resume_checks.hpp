// What must hold of a run's folder before `thawslide resume` goes on with it. All throw UserError where it does not.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/case.hpp"
#include "io/provenance.hpp"

namespace thawslide::app {

[[nodiscard]] std::string sha256_of_text(const std::string& text);

// What to do about changes of case.toml; otherwise: than for a later end.
[[nodiscard]] std::string advice_on(const std::filesystem::path& folder, const io::Provenance& facts,
                                    const std::vector<std::string>& changes, const std::string& otherwise);

// The copies that the run reads must be those it began with. Those of [report], with which only figures compare,
// may change.
void require_same_inputs(const std::filesystem::path& folder, const std::vector<io::InputFile>& inputs,
                         const config::Report& compared);

// Of the files that the user gave, those that have changed, as notes: a run goes on with its copies, whatever has
// become of them.
[[nodiscard]] std::vector<std::string> changed_originals(const std::vector<io::InputFile>& inputs);

// What of the results of a run at its end is missing or cut off, as notes.
[[nodiscard]] std::vector<std::string> gaps_in_results(const std::filesystem::path& folder,
                                                       const io::Provenance& facts);

// Called for an error of reading the case: where it is of a copy that has changed, it is told as that change.
void report_changed_copy(const std::filesystem::path& folder, const std::vector<io::InputFile>& inputs,
                         const std::string& error);

// case.toml must be what the run's checkpoint was written with (`before`), or what resumes since have made of it; what
// `sets` replaces may be anything. Changes by resumes that were cut off must be among `sets`.
void require_same_case(const std::filesystem::path& folder, const io::Provenance& facts, const std::string& before,
                       const std::vector<std::string>& sets);

// The same before the first checkpoint, when nothing but its SHA-256 tells what the case was.
void require_case_of_start(const std::filesystem::path& folder, const io::Provenance& facts,
                           const std::vector<std::string>& sets);

// A run without checkpoints begins anew, which it may where it was cut off before the first.
void require_no_more_than_a_start(const std::filesystem::path& folder, const io::Provenance& facts);

}  // namespace thawslide::app
