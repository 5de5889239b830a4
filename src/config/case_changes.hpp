// What may change of a case when its run goes on, and how two resolved cases differ.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace thawslide::config {

// How the resolved case `now` differs from `before`, both TOML texts: "time.end is 20.0, was 10.0", one entry a key, in
// the order of keys. The title and [report] do not count, since they change no run. A text that is no TOML is one
// difference. Keys `apart_from` do not count either.
std::vector<std::string> differences(const std::string& now, const std::string& before,
                                     const std::set<std::string>& apart_from = {});

// The keys that `--set` texts name. Throws UserError for a text without a key.
std::set<std::string> keys_of(const std::vector<std::string>& sets);

// Throws UserError where one of the `--set` texts names a key that a run which goes on cannot change: what made its
// first state, its grid, its ground and its records, and the laws it keeps state for.
void require_changeable(const std::vector<std::string>& sets);

// Those that can, in words.
std::string changeable_keys();

}  // namespace thawslide::config
