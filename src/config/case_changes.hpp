// Changes of a case: those that make it a trial, those permitted on resume, and differences between two resolved cases.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

// Factor of cells, steps and map cells of a trial.
inline constexpr double trial_factor = 2.0;

// Changes that make a case a trial, as `--set` texts: cells of twice the size, with the steps and maps that belong to
// them.
[[nodiscard]] std::vector<std::string> coarse_changes(const Case& parameters);

// Differences of the resolved case `now` from `before`, both TOML texts: "time.end is 20.0, was 10.0", one entry per
// key, in the order of keys. The title and [report] do not count, because they do not affect a run. A text that is not
// TOML is one difference. Keys in `apart_from` do not count either.
std::vector<std::string> differences(const std::string& now, const std::string& before,
                                     const std::set<std::string>& apart_from = {});

// Keys in `--set` texts. Throws UserError for a text without a key.
std::set<std::string> keys_of(const std::vector<std::string>& sets);

// Throws UserError if a `--set` text names a key that cannot be changed on resume: one that determines the initial
// state, the grid, the ground, the records, or laws with stored state. read_case refuses unknown keys before.
void require_changeable(const std::vector<std::string>& sets);

// List of the changeable keys as text.
std::string changeable_keys();

}  // namespace thawslide::config
