// Files in a folder that belong to a run and are removed with it; other files belong to the user and are kept.
#pragma once

#include <filesystem>

namespace thawslide::io {

// True if there is a run.json written by this program. Throws UserError if it cannot be read.
[[nodiscard]] bool holds_a_run(const std::filesystem::path& folder);

// True if a process that ended before writing run.json has left its lock and no results.
[[nodiscard]] bool holds_no_more_than_a_start(const std::filesystem::path& folder);

// Removes the files of a run by their names, links instead of their targets, and its folders if they are then empty. In
// inputs/, these are the copies listed in run.json. run.json is removed last, because it identifies the folder as that
// of a run. Throws WriteError.
void remove_files_of_run(const std::filesystem::path& folder);

}  // namespace thawslide::io
