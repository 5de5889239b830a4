// Changes of a case: those that make it a trial, those permitted on resume, and differences between two resolved cases.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

// Factor of cells, steps and map cells of a trial.
inline constexpr double trial_factor = 2.0;

// Changes that make a case a trial, as `--set` texts: cells of twice the size, with their steps and maps.
[[nodiscard]] std::vector<std::string> coarse_changes(const Case& parameters);

// Differences of resolved cases that affect a run, by key: "time.end is 20.0, was 10.0". Omits `apart_from`.
std::vector<std::string> differences(const std::string& now, const std::string& before,
                                     const std::set<std::string>& apart_from = {});

// Keys in `--set` texts. Throws UserError for a text without a key.
std::set<std::string> keys_of(const std::vector<std::string>& sets);

// Throws UserError if a `--set` text names a key that cannot change on resume, because earlier results depend on it.
void require_changeable(const std::vector<std::string>& sets);

}  // namespace thawslide::config
